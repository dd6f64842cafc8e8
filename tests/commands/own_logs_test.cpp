// Logs in columns of their own, and mistakes in logs: each is named.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"
#include "support/tree.hpp"

namespace rift {
namespace {

using test::ProcessResult;
using test::RunRift;
using test::TemporaryFolder;
using test::WriteText;

constexpr double kPi = 3.14159265358979323846;

struct Row {
  double t, x, y, yaw;
};
using Rows = std::vector<Row>;

/// A path that turns left and right, 1.25 m in 5 s; `error_m` is how far the robot strays.
Rows Path(double error_m) {
  Rows rows;
  double x = 0.1, y = -0.2;
  for (int i = 0; i < 100; ++i) {
    const double yaw = 0.4 + 1.0 * std::sin(0.06 * i);
    rows.push_back({0.05 * i, x, y + error_m * std::sin(0.03 * i), yaw});
    x += 0.0125 * std::cos(yaw);
    y += 0.0125 * std::sin(yaw);
  }
  return rows;
}

/// 0.6 m along x beside the axis, which the robot strays towards by `error_m`.
Rows StraightPath(double y_m, double error_m) {
  Rows rows;
  for (int i = 0; i < 100; ++i) {
    rows.push_back({0.05 * i, -0.3 + 0.006 * i, y_m + error_m * std::sin(0.03 * i),
                    std::atan(5.0 * error_m * std::cos(0.03 * i))});
  }
  return rows;
}

std::string Csv(const Rows& rows, const std::string& header = "t_s,x_m,y_m,yaw_rad") {
  std::string text = header + "\n";
  for (const Row& row : rows) {
    text += fmt::format("{:.6f},{:.9f},{:.9f},{:.9f}\n", row.t, row.x, row.y, row.yaw);
  }
  return text;
}

struct Logs {
  Rows sim = Path(0.0);
  Rows real = Path(0.02);
  std::string sim_name = "a.csv", real_name = "b.csv";
  std::string header = "t_s,x_m,y_m,yaw_rad";
  std::vector<std::string> flags{};
};

using Change = std::function<void(Logs&)>;

Change OfReal(const std::function<void(Row&)>& change) {
  return [change](Logs& logs) {
    for (Row& row : logs.real) change(row);
  };
}

struct Mistake {
  std::string name;
  Change make;
  std::string said;
};

std::vector<Mistake> Mistakes() {
  return {
      {"degrees for radians", OfReal([](Row& r) { r.yaw *= 180 / kPi; }),
       "degrees read as radians"},
      {"radians for degrees",
       [](Logs& l) {
         l.flags = {"--real-columns", "t=t_s,x=x_m,y=y_m,yaw=yaw_rad:deg"};
       },
       "radians read as degrees"},
      {"millimetres", OfReal([](Row& r) { r.x *= 1000, r.y *= 1000; }),
       "--real-columns 't=...,x=...:mm,y=...:mm'"},
      {"centimetres", OfReal([](Row& r) { r.x *= 100, r.y *= 100; }), "positions in mm or cm"},
      {"inches", OfReal([](Row& r) { r.x /= 0.0254, r.y /= 0.0254; }), "inches for m"},
      {"metres read as millimetres",
       [](Logs& l) {
         l.flags = {"--real-columns", "t=t_s,x=x_m,y=y_m,yaw=yaw_rad", "--real-units", "mm"};
       },
       "the whole path lies within 0.00"},
      {"milliseconds", OfReal([](Row& r) { r.t *= 1000; }), "are its times in ms"},
      {"microseconds", OfReal([](Row& r) { r.t *= 1e6; }), "are its times in ms, us"},
      {"seconds read as milliseconds",
       [](Logs& l) {
         l.flags = {"--real-columns", "t=t_s,x=x_m,y=y_m,yaw=yaw_rad", "--real-units", "ms"};
       },
       "are its times in another unit"},
      {"swapped, by name", [](Logs& l) { l.sim_name = "robot3.csv", l.real_name = "gazebo.csv"; },
       "by their names the two are swapped"},
      {"swapped, by format",
       [](Logs& l) {
         l.header = "t,x,y,yaw", l.flags = {"--sim-format", "tracker"};
       },
       "by their formats the two are swapped"},
      {"swapped, by noise",
       [](Logs& l) {
         for (size_t i = 0; i < l.sim.size(); ++i) {
           l.sim[i].t += i % 3 == 0 ? 0.015 : 0.0;
           l.sim[i].y += 0.001 * std::sin(2.1 * static_cast<double>(i * i));
         }
       },
       "by their noise the two are swapped"},
      {"a log cut at its end", [](Logs& l) { l.real.resize(55); },
       "whose gap is above 0.06 m: REAL covers only u = 0.00 to 0.5"},
      {"a log cut at its beginning",
       [](Logs& l) { l.real.erase(l.real.begin(), l.real.begin() + 50); }, "begins in motion"},
      {"positions with swapped axes", OfReal([](Row& r) { std::swap(r.x, r.y); }),
       "x and y swapped"},
      {"a yaw from north, clockwise", OfReal([](Row& r) { r.yaw = kPi / 2 - r.yaw; }),
       "a yaw from north, clockwise?"},
      {"y mirrored of a path that is nearly straight",
       [](Logs& l) {
         l.sim = StraightPath(-0.08, 0.0), l.real = StraightPath(-0.08, 0.01);
         for (Row& row : l.real) row.y = -row.y, row.yaw = -row.yaw;
       },
       "mirrored y"},
      {"the target's column as y", OfReal([](Row& r) { r.y = r.x < 0.4 ? -0.2 : 0.1; }),
       "the column of a target"},
      {"a frame with swapped axes",
       OfReal([](Row& r) { std::swap(r.x, r.y), r.yaw = kPi / 2 - r.yaw; }), "swapped axes"},
      {"positions with y mirrored", OfReal([](Row& r) { r.y = -r.y; }), "y mirrored"},
      {"a frame with y mirrored", OfReal([](Row& r) { r.y = -r.y, r.yaw = -r.yaw; }), "y=-COLUMN"},
      {"a frame with x mirrored", OfReal([](Row& r) { r.x = -r.x, r.yaw = kPi - r.yaw; }),
       "mirrored x"},
      {"a frame turned by half a turn",
       OfReal([](Row& r) { r.x = -r.x, r.y = -r.y, r.yaw += kPi; }), "half a turn"},
      {"a yaw from another zero", OfReal([](Row& r) { r.yaw += kPi / 2; }), "a quarter turn off"},
      {"another column as yaw", OfReal([](Row& r) { r.yaw = 7.0 * r.t; }), "is it another column?"},
      {"one column for x and y",
       [](Logs& l) {
         l.flags = {"--real-columns", "t=t_s,x=x_m,y=x_m"};
       },
       "x and y are both column 'x_m'"},
      {"a quaternion with w first",
       [](Logs& l) {
         l.header = "t_s,x_m,y_m,yaw_rad,a,b,c,d";
         l.flags = {"--real-columns", "t=t_s,x=x_m,y=y_m,qx=a,qy=b,qz=c,qw=d"};
       },
       "a quaternion in another order"},
      {"doubled rows",
       [](Logs& l) {
         Rows rows;
         for (Row row : l.real) {
           rows.push_back(row);
           row.t += 0.002;
           rows.push_back(row);
         }
         l.real = rows;
       },
       "are its rows doubled?"},
      {"a file appended to itself",
       [](Logs& l) {
         const Rows again = l.real;
         l.real.insert(l.real.end(), again.begin(), again.end());
       },
       "rows share the time of another"},
      {"rows in reverse", [](Logs& l) { std::reverse(l.real.begin(), l.real.end()); },
       "time runs backwards"},
      {"a Unix clock", OfReal([](Row& r) { r.t += 1.7e9; }), "their clocks differ: SIM begins at"},
      {"a clock in minutes", OfReal([](Row& r) { r.t /= 60; }), "their clocks differ: SIM lasts"},
      {"one log as both sides", [](Logs& l) { l.real = l.sim; }, "are the same log"},
  };
}

/// The fourth column repeated as a quaternion, w first, where the header asks for one.
std::string WithQuaternion(const Rows& rows, const std::string& header) {
  std::string text = header + "\n";
  for (const Row& r : rows) {
    text += fmt::format("{},{},{},{},{},0,0,{}\n", r.t, r.x, r.y, r.yaw, std::cos(r.yaw / 2),
                        std::sin(r.yaw / 2));
  }
  return text;
}

ProcessResult GapOf(const Logs& logs) {
  const TemporaryFolder folder;
  const bool has_quaternion = logs.header.ends_with(",d");
  const std::string header = has_quaternion ? "t_s,x_m,y_m,yaw_rad" : logs.header;
  WriteText(folder / logs.sim_name, Csv(logs.sim, header));
  WriteText(folder / logs.real_name,
            has_quaternion ? WithQuaternion(logs.real, logs.header) : Csv(logs.real, header));
  std::vector<std::string> arguments{"gap", folder / logs.sim_name, folder / logs.real_name};
  arguments.insert(arguments.end(), logs.flags.begin(), logs.flags.end());
  return RunRift(arguments);
}

TEST_CASE("Each of 33 mistakes in a log is named by rift gap") {
  const std::vector<Mistake> mistakes = Mistakes();
  CHECK(mistakes.size() == 33);
  for (const Mistake& mistake : mistakes) {
    DYNAMIC_SECTION(mistake.name) {
      Logs logs;
      mistake.make(logs);
      const ProcessResult result = GapOf(logs);
      INFO(result.err);
      CHECK(result.err.find(mistake.said) != std::string::npos);
    }
  }
}

TEST_CASE("Clocks are held against each other without the standstill that is trimmed") {
  Logs logs;
  for (Row& row : logs.real) row.t += 60.0;  // it stands for a minute before
  logs.real.insert(logs.real.begin(), {0.0, logs.real.front().x, logs.real.front().y, 0.4});
  CHECK(GapOf(logs).err.find("their clocks differ: SIM lasts 4.95 s and REAL 65 s") !=
        std::string::npos);
  logs.flags = {"--trim-standstill"};
  CHECK(GapOf(logs).err.find("clocks differ") == std::string::npos);
}

TEST_CASE("A gap that grows with the starts laid together is not called a part of it") {
  Logs logs;
  for (Row& row : logs.real) row.y -= 0.02;  // half the difference at the end
  const std::string text = GapOf(logs).out;
  INFO(text);
  CHECK(text.find("left over") == std::string::npos);
  CHECK(text.find("with the starts laid together the gap is 0.0198 m; after the best") !=
        std::string::npos);
}

TEST_CASE("Sound logs are read without a word") {
  Logs beside_the_axis;  // on two sides of it
  beside_the_axis.sim = StraightPath(0.02, 0.0);
  beside_the_axis.real = StraightPath(-0.02, 0.0);
  Logs along_the_axis;
  along_the_axis.sim = StraightPath(0.0, 0.0);
  along_the_axis.real = StraightPath(0.0, 0.02);
  for (const Logs& logs : {Logs{}, beside_the_axis, along_the_axis}) {
    const ProcessResult result = GapOf(logs);
    CHECK(result.exit_code == 0);
    CHECK(result.err.empty());
  }
}

TEST_CASE("rift gap doubts neither its own logs nor the example's") {
  const std::string example = test::SourceDir() + "/data/example/";
  const ProcessResult of_example =
      RunRift({"gap", example + "simulator.csv", example + "robot1.csv", example + "robot2.csv"});
  CHECK(of_example.err.empty());
  const TemporaryFolder folder;
  const std::string task = test::SourceDir() + "/configs/waypoints/paper.yaml";
  for (const std::string surface : {"ground", "cardboard", "parchment", "uphill", "downhill"}) {
    INFO(surface);
    const std::string set = "simulation.terrain.surface=" + surface;
    for (const std::string seed : {"1", "2"}) {
      RunRift({"simulate", task, "--seed", seed, "--set", set, "--out", folder / (surface + seed)});
    }
    const ProcessResult result = RunRift(
        {"gap", folder / (surface + "1/trajectory.csv"), folder / (surface + "2/trajectory.csv")});
    CHECK(result.err.find("warning") == std::string::npos);
  }
}

TEST_CASE("rift gap doubts none of the authors' trials") {
  RIFT_SKIP_WITHOUT_TRIALS();
  for (const test::TrialPair& pair : test::PublishedPairs()) {
    const ProcessResult result =
        RunRift({"gap", pair.webots.string(), pair.real.string(), "--sim-format", "webots",
                 "--real-format", "tracker", "--tag-offset", "0.03"});
    INFO(pair.real.string());
    CHECK(result.exit_code == 0);
    CHECK(result.err.find("warning") == std::string::npos);
  }
}

/// One log as four programs write it.
struct Sample {
  std::string name, header;
  std::function<std::string(const Row&)> row;
};

std::vector<Sample> Samples() {
  return {
      {"degrees and millimetres, semicolons and decimal commas",
       "Timestamp [ms];X (mm);Y (mm);Heading (deg)",
       [](const Row& r) {
         std::string text = fmt::format("{:.1f};{:.6f};{:.6f};{:.6f}", 1000 * r.t, 1000 * r.x,
                                        1000 * r.y, r.yaw * 180 / kPi);
         std::replace(text.begin(), text.end(), '.', ',');
         return text;
       }},
      {"a quaternion", "time,pos_x,pos_y,pos_z,quat_x,quat_y,quat_z,quat_w",
       [](const Row& r) {
         return fmt::format("{},{},{},0.02,0,0,{},{}", r.t, r.x, r.y, std::sin(r.yaw / 2),
                            std::cos(r.yaw / 2));
       }},
      {"EuRoC",
       "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],"
       "q_RS_z [],v_RS_R_x [m s^-1],v_RS_R_y [m s^-1],b_w_RS_S_x [rad s^-1]",
       [](const Row& r) {
         return fmt::format("{},{},{},0.5,{},0,0,{},0.1,0.2,0.003",
                            1403636580838555648LL + std::llround(r.t * 1e9), r.x, r.y,
                            std::cos(r.yaw / 2), std::sin(r.yaw / 2));
       }},
      {"blanks below a comment that names the columns", "# time(ms) tcp_x tcp_y tcp_yaw",
       [](const Row& r) {
         return fmt::format("{:.3f} {:.9f} {:.9f} {:.9f}", 1000 * r.t, r.x, r.y, r.yaw);
       }},
      {"ROS, nested names",
       "%time,field.header.seq,field.header.frame_id,field.pose.pose.position.x,"
       "field.pose.pose.position.y,field.pose.pose.position.z,field.pose.pose.orientation.x,"
       "field.pose.pose.orientation.y,field.pose.pose.orientation.z,field.pose.pose.orientation.w,"
       "field.twist.twist.linear.x,field.twist.twist.angular.z",
       [](const Row& r) {
         return fmt::format("{},7,odom,{},{},0,0,0,{},{},0.25,0.1",
                            1700000000000000000LL + static_cast<long long>(r.t * 1e9), r.x, r.y,
                            std::sin(r.yaw / 2), std::cos(r.yaw / 2));
       }},
      {"ROS 2, seconds and nanoseconds",
       "header.stamp.sec,header.stamp.nanosec,pose.pose.position.x,pose.pose.position.y,"
       "pose.pose.orientation.z,pose.pose.orientation.w",
       [](const Row& r) {
         return fmt::format("{},{},{},{},{},{}", 1700 + static_cast<int>(r.t),
                            std::lround((r.t - std::floor(r.t)) * 1e9), r.x, r.y,
                            std::sin(r.yaw / 2), std::cos(r.yaw / 2));
       }},
      {"numbers without a name", "0.000000,0.1,-0.2,0.4",
       [](const Row& r) {
         return fmt::format("{:.6f},{:.9f},{:.9f},{:.9f}", r.t + 1, r.x, r.y, r.yaw);
       }},
  };
}

TEST_CASE("A log of another program is read by pasting the flag that the message offers") {
  for (const Sample& sample : Samples()) {
    DYNAMIC_SECTION(sample.name) {
      const TemporaryFolder folder;
      const std::string sim = folder / "a.csv", real = folder / "b.csv";
      WriteText(sim, Csv(Path(0.0)));
      std::string text = sample.header + "\n";
      for (const Row& row : Path(0.02)) text += sample.row(row) + "\n";
      WriteText(real, text);
      const ProcessResult refused = RunRift({"gap", sim, real});
      CHECK(refused.exit_code == 2);
      const std::string offer = "is it this? --real-columns '";
      const size_t begin = refused.err.find(offer);
      INFO(refused.err);
      REQUIRE(begin != std::string::npos);
      const size_t columns = begin + offer.size();
      const std::string guess =
          refused.err.substr(columns, refused.err.find('\'', columns) - columns);
      INFO(guess);
      const ProcessResult read = RunRift({"gap", sim, real, "--real-columns", guess});
      INFO(read.err);
      CHECK(read.exit_code == 0);
      CHECK(read.out.find("mean gap: 0.0198 m") != std::string::npos);
      CHECK(read.out.find("yaw") != std::string::npos);
      CHECK(read.err.find("yaw") == std::string::npos);
    }
  }
}

TEST_CASE("Columns that are not there, or no quantity, or no unit, are refused by name") {
  const auto refusal = [](const std::vector<std::string>& flags) {
    const ProcessResult result = GapOf({.flags = flags});
    CHECK(result.exit_code == 2);
    return result.err;
  };
  CHECK(refusal({"--columns", "t=t_s,x=x_m,y=why"}).find("'why', and there is no such column") !=
        std::string::npos);
  CHECK(refusal({"--columns", "t=t_s,x=x_m"}).find("y is missing") != std::string::npos);
  CHECK(refusal({"--columns", "t=t_s,x=x_m,y=y_m,w=yaw_rad"}).find("'w' is no quantity") !=
        std::string::npos);
  CHECK(refusal({"--columns", "t=t_s,x=x_m:deg,y=y_m"}).find("'deg' is no unit of x") !=
        std::string::npos);
  CHECK(refusal({"--units", "mm,m"}).find("names one kind twice") != std::string::npos);
}

TEST_CASE("A sweep reads logs by reference.columns and candidate.columns") {
  const test::QuickGnuplot gnuplot;
  const TemporaryFolder folder;
  WriteText(folder / "sim.csv", Csv(Path(0.0), "time,east,north,heading"));
  WriteText(folder / "real_1.csv", Csv(Path(0.02), "time,east,north,heading"));
  WriteText(folder / "sweep.yaml",
            "candidate: {kind: logs, path: sim.csv, columns: 't=time,x=east,y=north'}\n"
            "reference: {kind: logs, path: 'real_{trial}.csv',\n"
            "            columns: 't=time,x=east,y=north,yaw=heading'}\n");
  const ProcessResult result = RunRift({"sweep", folder / "sweep.yaml", "--out", folder / "out"});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  const std::string table = test::ReadFile(std::filesystem::path(folder / "out") / "table.csv");
  CHECK(table.find(",ok,") != std::string::npos);
  const ProcessResult bare = RunRift(
      {"sweep", folder / "sweep.yaml", "--out", folder / "bare", "--set", "reference.columns=''"});
  const std::string reason = test::ReadFile(std::filesystem::path(folder / "bare") / "table.csv");
  CHECK(reason.find("--set reference.columns='t=time,x=east,y=north,yaw=heading'") !=
        std::string::npos);
}

}  // namespace
}  // namespace rift
