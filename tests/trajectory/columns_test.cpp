// Logs in columns of their own: separators, units, sums, quaternions, and what is refused.
#include "trajectory/columns.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "rift/trajectory/log.hpp"

namespace rift::trajectory {
namespace {

using Catch::Matchers::Contains;

Trajectory Read(const std::string& text, const std::string& columns,
                const std::string& units = "") {
  return ReadLog(text, "log.csv", ReadOptions{.columns = columns, .units = units}).trajectory;
}

TEST_CASE("Every unit is what it is in metres, seconds and radians") {
  const std::vector<std::pair<std::string, double>> lengths{
      {"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"km", 1000.0}, {"in", 0.0254}, {"ft", 0.3048}};
  const std::vector<std::pair<std::string, double>> times{
      {"s", 1.0}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}, {"min", 60.0}};
  for (const auto& [name, in_m] : lengths) {
    INFO(name);
    for (const char* quantity : {"x", "y", "z", "target_x", "target_y"}) {
      CHECK(UnitFor(quantity, name) == in_m);
    }
    CHECK_FALSE(UnitFor("t", name));
    CHECK_FALSE(UnitFor("yaw", name));
    CHECK(ParseUnits(name).length_m == in_m);
  }
  for (const auto& [name, in_s] : times) {
    INFO(name);
    CHECK(UnitFor("t", name) == in_s);
    CHECK_FALSE(UnitFor("x", name));
    CHECK_FALSE(UnitFor("roll", name));
    CHECK(ParseUnits(name).time_s == in_s);
  }
  for (const char* angle : {"roll", "pitch", "yaw"}) {
    CHECK(UnitFor(angle, "rad") == 1.0);
    CHECK(*UnitFor(angle, "deg") == Approx(3.14159265358979 / 180.0));
  }
  CHECK_FALSE(UnitFor("qx", "rad"));
  CHECK_FALSE(UnitFor("x", ""));
  const Units three = ParseUnits(" mm, ms ,deg");
  CHECK(three.length_m == 0.001);
  CHECK(three.time_s == 1e-3);
  CHECK(*three.angle_rad == Approx(0.0174532925));
  CHECK_FALSE(ParseUnits("").length_m);
  CHECK_THROWS_WITH(ParseUnits("mm,cm"), "units: 'mm,cm' names one kind twice");
  CHECK_THROWS_WITH(
      ParseUnits("mm,parsec"),
      "units: 'parsec' is none of m, cm, mm, km, in, ft, s, ms, us, ns, min, rad, deg");
}

TEST_CASE("Each quantity is read from its own column in its own unit") {
  const Trajectory log = Read(
      "clock,a,b,c,d,e,f,g,h\n10,1,2,3,4,5,6,7,8\n20,11,12,13,14,15,16,17,18\n",
      "t=clock:ms,x=a:cm,y=b:mm,z=c,roll=d:deg,pitch=e:deg,yaw=f:deg,target_x=g,target_y=h:ft");
  REQUIRE(log.poses.size() == 2);
  const StampedPose& pose = log.poses[1];
  CHECK(pose.t_s == Approx(0.020));
  CHECK(pose.x_m == Approx(0.11));
  CHECK(pose.y_m == Approx(0.012));
  CHECK(pose.z_m == 13.0);
  CHECK(pose.roll_rad == Approx(14.0 * 0.01745329252));
  CHECK(pose.pitch_rad == Approx(15.0 * 0.01745329252));
  CHECK(pose.yaw_rad == Approx(16.0 * 0.01745329252));
  CHECK(pose.target_x_m == 17.0);
  CHECK(pose.target_y_m == Approx(18.0 * 0.3048));
}

TEST_CASE("Units of a kind hold for every quantity of it that names none") {
  const Trajectory log =
      Read("t,x,y,yaw\n1,10,20,90\n2,30,40,180\n", "t=t,x=x,y=y:m,yaw=yaw", "cm,min,deg");
  CHECK(log.poses[1].t_s == 120.0);
  CHECK(log.poses[1].x_m == Approx(0.3));
  CHECK(log.poses[1].y_m == 40.0);
  CHECK(log.poses[0].yaw_rad == Approx(1.5707963268));
}

TEST_CASE("Columns are added, each with its own sign") {
  const Trajectory log =
      Read("sec,nano,x,y\n1,500000000,1,2\n2,250000000,3,5\n", "t=sec+nano:ns,x=-x,y=-y+x");
  CHECK(log.poses[0].t_s == Approx(1.5));
  CHECK(log.poses[1].t_s == Approx(2.25));
  CHECK(log.poses[0].x_m == -1.0);
  CHECK(log.poses[1].y_m == -2.0);  // -5 + 3
  CHECK(Read("t,off,ex,y\n0,1,0.25,0\n1,1,0.5,0\n", "t=t,x=off+-ex,y=y").poses[1].x_m == 0.5);
  CHECK(Read("t,off,ex,y\n0,1,25,0\n1,1,50,0\n", "t=t,x=off + -ex:cm,y=-y").poses[1].x_m == 0.5);
  CHECK_THROWS_WITH(Read("t,off,ex,y\n0,1,1,0\n1,1,2,0\n", "t=t,x=off-ex,y=y"),
                    Contains("x is to be 'off-ex', and there is no such column (a difference is "
                             "written A+-B): there are t, off, ex, y"));
  // A column whose name is the whole source comes first.
  const Trajectory named = Read("t,-x,a+b\n1,7,8\n2,9,10\n", "t=t,x=-x,y=a+b");
  CHECK(named.poses[0].x_m == 7.0);
  CHECK(named.poses[0].y_m == 8.0);
}

TEST_CASE("One column under two signs, units, numbers or orders is one column") {
  const auto refused = [](const std::string& columns, const std::string& says) {
    INFO(columns);
    CHECK_THROWS_WITH(Read("time,py,a,b\n0,1,2,3\n1,4,5,7\n", columns),
                      "log.csv:1: columns: " + says);
  };
  refused("t=time,x=py,y=-py", "x and y are both column 'py'");
  refused("t=time,x=py,y=2", "x and y are both column 'py'");
  refused("t=time,x=py:mm,y=py", "x and y are both column 'py'");
  refused("t=time,x=py:mm,y=-py:cm", "x and y are both column 'py'");
  refused("t=time:ms,x=a,y=time", "t and y are both column 'time'");
  refused("t=time,x=a+b,y=-b+-a", "x and y are both column 'a+b'");
  // A frame turned by an eighth of a turn is one of sums.
  CHECK(Read("time,a,b\n0,2,3\n1,5,7\n", "t=time,x=a+b,y=a+-b").poses[1].y_m == -2.0);
}

TEST_CASE("Without a header the first line is a row, also beside a column of text") {
  const std::string text = "0,3,2,idle\n1,4,5,go\n2,6,5,go\n";
  for (const std::string columns : {"t=1,x=2,y=3", "t=1,x=2,y=3:m", "t=1,x=2,y=-3"}) {
    INFO(columns);
    const Trajectory log = Read(text, columns);
    REQUIRE(log.poses.size() == 3);
    CHECK(log.poses[0].x_m == 3.0);
    CHECK(std::abs(log.poses[0].y_m) == 2.0);
  }
  CHECK(Read("0,0,0,idle\n1,4,5,go\n", "t=1,x=2,y=3").poses.size() == 2);  // a number twice
  CHECK(Read("# made by hand\n\n0;0,5;0,9;a\n1;1,5;0,8;b\n", "t=1,x=2,y=3").poses[0].y_m == 0.9);
  // A header whose names are asked for is one, and so is one of words.
  CHECK(Read("time,2,3,state\n0,7,8,idle\n1,9,8,go\n", "t=time,x=3,y=2").poses[0].x_m == 8.0);
  CHECK(Read("t,a,b,state\n0,7,8,idle\n1,9,8,go\n", "t=1,x=2,y=3").poses.size() == 2);
  CHECK_THROWS_WITH(Read("\n0,5,6\n1,7,8\n", "t=1,x=3,y=4"),
                    Catch::StartsWith("log.csv:2: columns: y is to be '4'"));
  CHECK_THROWS_WITH(Read("0,5,6\n1,7,8\n", "t=1,x=3,y=4"), Catch::StartsWith("log.csv:1: "));
}

TEST_CASE("Semicolons part numbers with decimal commas, however many of these there are") {
  const Trajectory log = Read("0,05;1,2;-3,4e-1\n0,10;1,3;-3,5\n", "t=1,x=2,y=3");
  REQUIRE(log.poses.size() == 2);
  CHECK(log.poses[0].t_s == 0.05);
  CHECK(log.poses[0].y_m == -0.34);
  CHECK(Read("0,05;1,2;3,4;idle\n0,10;1,3;3,5;go\n", "t=1,x=2,y=3").poses[0].x_m == 1.2);
  // Words between commas are no such numbers.
  CHECK(Read("t,x,y;m,a\n0,1,2.5,3\n1,2,3.5,3\n", "t=t,x=x,y=y;m").poses[1].y_m == 3.5);
  CHECK(Read("t;x;y\n0;1;2\n1;2;3\n", "t=t,x=x,y=y").poses[1].y_m == 3.0);
}

TEST_CASE("Rows that tracking has not measured are left out of a log in columns of its own") {
  const std::string text =
      "t_s,x_m,y_m,track_state,note\n0,0,0,0,a\n1,9,9,1,b\n2,1,0,0,c\n3,8,8,,d\n4,2,0,0,e\n";
  const Log log = ReadLog(text, "log.csv", ReadOptions{.columns = "t=t_s,x=x_m,y=-y_m"});
  CHECK(log.trajectory.poses.size() == 3);
  CHECK(log.notes == std::vector<std::string>{
                         "2 rows are left out: track_state is predicted, ambiguous or lost"});
  // Text is of another program's tracking.
  const std::string words = "t,x,y,track_state\n0,0,0,OK\n1,1,0,LOST\n";
  CHECK(Read(words, "t=t,x=x,y=y").poses.size() == 2);
  CHECK_THROWS_WITH(Read("t,x,y,track_state\n0,0,0,2\n1,1,0,2\n", "t=t,x=x,y=y"),
                    "log.csv: 0 poses, and a trajectory needs at least 2: 2 rows are left out: "
                    "track_state is predicted, ambiguous or lost");
}

TEST_CASE("A log of several robots is refused in columns of its own too") {
  const std::string text = "t,x,y,tag_id\n0,0,0,3\n1,5,5,7\n2,1,0,3\n";
  const std::string says = "log.csv: it holds several robots, tags 3 to 7: keep the rows of one";
  CHECK_THROWS_WITH(Read(text, "t=t,x=x,y=y"), Catch::StartsWith(says));
  CHECK_THROWS_WITH(Read(text, "", "mm"), Catch::StartsWith(says));
  CHECK(Read("t,x,y,tag_id\n0,0,0,3\n1,5,5,\n2,1,0,3\n", "t=t,x=x,y=y").poses.size() == 3);
}

TEST_CASE("A row whose quaternion lacks a part has no angles, whichever part it is") {
  for (const char* row : {",0,0,1", "0,,0,1", "0,0,,1", "0,0,0,"}) {
    INFO(row);
    const Log log =
        ReadLog("t,x,y,a,b,c,d\n0,0,0,0,0,0,1\n1,1,0," + std::string(row) + "\n2,2,0,0,0,0,1\n",
                "log.csv", ReadOptions{.columns = "t=t,x=x,y=y,qx=a,qy=b,qz=c,qw=d"});
    CHECK(std::isnan(log.trajectory.poses[1].yaw_rad));
    CHECK(log.trajectory.poses[2].yaw_rad == 0.0);
    CHECK(log.line_without_yaw == 3);
  }
}

TEST_CASE("A column is named by its number from 1 where no name is so") {
  const Trajectory log = Read("0,5,6\n1,7,8\n", "t=1,x=3,y=2");
  CHECK(log.poses[0].x_m == 6.0);
  CHECK(log.poses[0].y_m == 5.0);
  CHECK_THROWS_WITH(Read("0,5,6\n1,7,8\n", "t=1,x=3,y=4"), Contains("there is no such column"));
  CHECK_THROWS_WITH(Read("0,5,6\n1,7,8\n", "t=1,x=3,y=0"), Contains("there is no such column"));
  CHECK_THROWS_WITH(Read("0,5,6\n1,7,8\n", "t=1,x=3,y=2a"), Contains("there is no such column"));
}

TEST_CASE("A yaw of a quaternion is its turn about z, tilted ones have roll and pitch too") {
  const double half = 0.35;
  const auto text = [](double qx, double qy, double qz, double qw) {
    const std::string q = std::to_string(qx) + "," + std::to_string(qy) + "," + std::to_string(qz) +
                          "," + std::to_string(qw);
    return "t,x,y,a,b,c,d\n0,0,0," + q + "\n1,1,1," + q + "\n";
  };
  const std::string columns = "t=t,x=x,y=y,qx=a,qy=b,qz=c,qw=d";
  const StampedPose yaw = Read(text(0, 0, std::sin(half), std::cos(half)), columns).poses[0];
  CHECK(yaw.yaw_rad == Approx(0.7).epsilon(1e-5));
  CHECK(yaw.roll_rad == Approx(0.0).margin(1e-5));
  const StampedPose roll = Read(text(std::sin(half), 0, 0, std::cos(half)), columns).poses[0];
  CHECK(roll.roll_rad == Approx(0.7).epsilon(1e-5));
  CHECK(roll.yaw_rad == Approx(0.0).margin(1e-5));
  const StampedPose pitch = Read(text(0, std::sin(half), 0, std::cos(half)), columns).poses[0];
  CHECK(pitch.pitch_rad == Approx(0.7).epsilon(1e-5));
  // Without qx and qy it is upright.
  CHECK(
      Read(text(9, 9, std::sin(half), std::cos(half)), "t=t,x=x,y=y,qz=c,qw=d").poses[0].yaw_rad ==
      Approx(0.7).epsilon(1e-5));
  CHECK_THROWS_WITH(Read(text(0, 0, 0, 0), columns),
                    Contains("log.csv:2: the quaternion has zero"));
}

TEST_CASE("Columns that break a rule are refused with the rule") {
  const auto refused = [](const std::string& columns, const std::string& says) {
    INFO(columns);
    CHECK_THROWS_WITH(CheckColumns({.columns = columns}), Contains(says));
  };
  refused("t=a,x=b", "y is missing in 't=a,x=b'");
  refused("x=a,y=b", "t is missing");
  refused("t=a,y=b", "x is missing");
  refused("t=a,x=b,y", "columns: 'y' is no QUANTITY=COLUMN, such as yaw=theta:deg");
  refused("t=a,x=b,y= ", "is no QUANTITY=COLUMN");
  refused("t=a,x=b,y=c,w=d", "'w' is no quantity of a pose: they are t, x, y, z, roll, pitch, yaw");
  refused("t=a,x=b,y=c,x=d", "x is named twice");
  refused("t=a,x=b,y=b", "are both column 'b'");
  refused("t=a,x=b,y=c,qz=d", "columns: a quaternion needs qz and qw, and tilted ones qx and qy");
  refused("t=a,x=b,y=c,qw=d", "columns: a quaternion needs qz and qw, and tilted ones qx and qy");
  refused("t=a,x=b,y=c,qx=d,qy=e",
          "columns: a quaternion needs qz and qw, and tilted ones qx and qy");
  refused("t=a,x=b,y=c,qz=d,qw=e,yaw=f", "columns: yaw and a quaternion: leave one of them out");
  CHECK_NOTHROW(CheckColumns({.columns = "t=a,x=b,y=c,qz=d,qw=e"}));
  CHECK_NOTHROW(CheckColumns({.columns = " t = a , x = b , y = c "}));
  CHECK_THROWS_WITH(CheckColumns({.units = "furlong", .columns_flag = "--sim-columns "}),
                    Catch::StartsWith("--sim-units: 'furlong' is none of"));
  CHECK_THROWS_WITH(CheckColumns({.columns = "t=a", .columns_flag = "--set candidate.columns="}),
                    Catch::StartsWith("candidate.columns: x is missing"));
  CHECK_THROWS_AS(CheckColumns({.format = Format::kTum, .columns = "t=a,x=b,y=c"}),
                  std::invalid_argument);
}

TEST_CASE("A unit that a quantity cannot have is refused with both") {
  CHECK_THROWS_WITH(Read("a,b,c\n0,1,2\n1,2,3\n", "t=a:mm,x=b,y=c"),
                    Contains("'mm' is no unit of t"));
  CHECK_THROWS_WITH(Read("a,b,c\n0,1,2\n1,2,3\n", "t=a,x=b:deg,y=c"),
                    Contains("'deg' is no unit of x"));
}

TEST_CASE("A cell that is no number is refused by its column, a row without position left out") {
  CHECK_THROWS_WITH(Read("a,b,c\n0,1,2\n1,two,3\n", "t=a,x=b,y=c"),
                    "log.csv:3: column b is 'two': a finite number is expected");
  CHECK_THROWS_WITH(Read("a,b,c\n0,1,2\n,2,3\n", "t=a,x=b,y=c"), "log.csv:3: column a is empty");
  CHECK_THROWS_WITH(Read("a,n,b,c\n0,0,1,2\n,5,2,3\n", "t=a+n:ns,x=b,y=c"),
                    "log.csv:3: column a is empty");
  CHECK_THROWS_WITH(Read("a,b,c\n0,1,2\n1,,3\n", "t=a,x=b,y=c"), "log.csv:3: column b is empty");
  CHECK_THROWS_WITH(Read("a,b,c\n0,1,2\n1,2,\n", "t=a,x=b,y=c"), "log.csv:3: column c is empty");
  const Log log =
      ReadLog("a,b,c\n0,1,2\n1,,\n2,,\n3,2,3\n", "log.csv", ReadOptions{.columns = "t=a,x=b,y=c"});
  CHECK(log.trajectory.poses.size() == 2);
  CHECK(log.notes == std::vector<std::string>{"2 rows are left out: no position"});
}

TEST_CASE("Cells stand between commas, semicolons, tabs or blanks, whichever the first line has") {
  const auto y_of = [](const std::string& text) {
    return Read(text, "t=t,x=x,y=y").poses.at(1).y_m;
  };
  CHECK(y_of("t,x,y\n0,1,2.5\n1,2,3.5\n") == 3.5);
  CHECK(y_of("t;x;y\n0;1;2,5\n1;2;3,5\n") == 3.5);
  CHECK(y_of("t;x;y\n0;1;2.5\n1;2;3.5\n") == 3.5);
  CHECK(Read("t,x,y;m\n0,1,2.5\n1,2,3.5\n", "t=t,x=x,y=y;m").poses[1].y_m == 3.5);
  CHECK(y_of("t\tx\ty\n0\t1\t2.5\n1\t2\t3.5\n") == 3.5);
  CHECK(y_of("t x y\n0 1 2.5\n1 2 3.5\n") == 3.5);
  CHECK(y_of("# a comment\n# t x y\n0 1 2.5\n\n# more\n1 2 3.5\n") == 3.5);
  CHECK_THROWS_WITH(y_of("t;x;y\n0;1;2\n1;2;1.234,5\n"), Contains("column y is '1.234,5'"));
  CHECK_THROWS_WITH(y_of("t;x;y\n0;1;2\n1;2;1,234,5\n"), Contains("column y is '1,234,5'"));
  CHECK_THROWS_WITH(y_of("t,x,y\n0,1,2\n1,2\n"),
                    "log.csv:3: the row has 2 cells where 3 are expected");
  CHECK_THROWS_WITH(y_of("t,x,x\n0,1,2\n"), Contains("two columns 'x'"));
}

TEST_CASE("Between tabs names hold blanks and cells are empty, where the first row has them too") {
  const auto y_of = [](const std::string& text, const std::string& columns) {
    return Read(text, columns).poses.at(1).y_m;
  };
  const std::string named = "t=Time [s],x=X [m],y=Y [m]";
  CHECK(y_of("Time [s]\tX [m]\tY [m]\n0\t1\t2.5\n1\t2\t3.5\n", named) == 3.5);
  CHECK(y_of("# Time [s]\tX [m]\tY [m]\n0\t1\t2.5\n1 \t 2\t3.5\n", named) == 3.5);
  CHECK(y_of("Time [s]\tX [m]\tnote\tY [m]\t\n\n# a\n0\t1\t\t2.5\t\n1\t2\tno tag\t3.5\t\n",
             named) == 3.5);
  const std::string plain = "t=t,x=x,y=y";
  CHECK(y_of("t\tx\ty\n0 1  2.5\n1 2 3.5\n", plain) == 3.5);
  CHECK(y_of("t\tx\ty\n0\t\t1\t2.5\n1\t2\t3.5\n", plain) == 3.5);
  CHECK_THROWS_WITH(y_of("t\tx\ty\n0\t1\t2.5\n1\t2\n", plain),
                    "log.csv:3: the row has 2 cells where 3 are expected");
  const std::string name = "log";
  CHECK(TextTable("a b\tc\n", name).Columns() == std::vector<std::string>{"a b", "c"});
}

TEST_CASE("A table tells its lines, and columns without names are numbers from 1") {
  const std::string name = "log";
  TextTable table("0 1\n\n2 3\n", name);
  CHECK(table.Columns() == std::vector<std::string>{"1", "2"});
  REQUIRE(table.Next());
  CHECK(table.Line() == 1);
  CHECK(table.Number(1) == 1.0);
  REQUIRE(table.Next());
  CHECK(table.Line() == 3);
  CHECK(table.Cell(0) == "2");
  CHECK_FALSE(table.Next());
  // Of as many commas as semicolons or tabs the commas part the cells, and then the semicolons.
  CHECK(TextTable("a,b;c\td\n", name).Columns() == std::vector<std::string>{"a", "b;c\td"});
  CHECK(TextTable("b;c\td\n", name).Columns() == std::vector<std::string>{"b", "c\td"});
  // A comment of another number of words names no columns.
  TextTable other("# made by a robot\n0 1\n2 3\n", name);
  CHECK(other.Columns() == std::vector<std::string>{"1", "2"});
  TextTable named("a;b\n1;\nc;4\n", name);
  REQUIRE(named.Next());
  CHECK(std::isnan(named.Number(1).value()));
  REQUIRE(named.Next());
  CHECK_FALSE(named.Number(0));
}

TEST_CASE("Units without columns are of columns that are guessed, or none are found") {
  CHECK(Read("time,x,y\n0,10,20\n1,30,40\n2,50,60\n", "", "cm").poses[1].x_m == Approx(0.3));
  CHECK_THROWS_WITH(Read("a,b\nred,1\nblue,2\n", "", "cm"),
                    Contains("units are given, and no columns are found for time, x and y"));
}

TEST_CASE("Columns that were guessed are told, and those that may be a place where none is taken") {
  const Log log = ReadLog("time,x,y,yaw\n0,10,20,1\n1,30,40,1\n2,50,60,1\n", "log.csv",
                          ReadOptions{.units = "cm", .columns_flag = "--real-columns "});
  CHECK(log.notes == std::vector<std::string>{"read as --real-columns 't=time,x=x,y=y,yaw=yaw'"});
  CHECK_THROWS_WITH(
      Read("time,x_ref,y_ref,x_meas,y_meas\n0,1,2,3,4\n1,2,3,4,5\n2,3,5,5,7\n", "", "mm"),
      "log.csv: units are given, and no columns are found for time, x and y: name them with "
      "--columns t=...,x=...,y=...; x may be x_ref or x_meas, y may be y_ref or y_meas");
}

TEST_CASE("Words of a column's name tell its quantity and what is none of the pose") {
  // A log of a straight way with one column more; what that is guessed to be.
  const auto guessed = [](const std::string& column, double from, double step) {
    std::string text = "t,x,y," + column + "\n";
    for (int i = 0; i < 40; ++i) {
      text += std::to_string(0.1 * i) + "," + std::to_string(0.03 * i) + "," +
              std::to_string(0.001 * i * i) + "," + std::to_string(from + step * i) + "\n";
    }
    const std::string guess = GuessColumns(text, "log", "").columns;
    const size_t at = guess.find("=" + column);
    return at == guess.npos ? ""
                            : guess.substr(guess.rfind(',', at) + 1, at - guess.rfind(',', at) - 1);
  };
  for (const char* yaw :
       {"yaw", "theta", "heading", "psi", "phi", "angle", "robotYaw", "th", "rz"}) {
    INFO(yaw);
    CHECK(guessed(yaw, 0.0, 0.01) == "yaw");
  }
  for (const char* height : {"z", "posz", "pz", "tz", "zpos", "height", "up"}) {
    INFO(height);
    CHECK(guessed(height, 0.1, 0.0001) == "z");
  }
  CHECK(guessed("roll", 0.0, 0.001) == "roll");
  CHECK(guessed("pitch", 0.0, 0.001) == "pitch");
  for (const char* none : {"vel_z", "cmd.yaw", "yaw_rate", "target_z", "goal_yaw", "z_error",
                           "desired_yaw", "speed", "twist.angular.z", "ref_z"}) {
    INFO(none);
    CHECK(guessed(none, 0.0, 0.01).empty());
  }
}

}  // namespace
}  // namespace rift::trajectory
