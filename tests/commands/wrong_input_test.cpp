// The contract with a person who mistypes: every wrong input ends with exit code 2 (or what is
// said), prints nothing on stdout and one line on stderr that names the thing and the mend, and
// leaves no file behind.
#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/processes/quick_gnuplot.hpp"
#include "support/tree.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

/// Words are split at spaces; @ is the test's folder, % the source tree and '' an empty word.
struct WrongInput {
  std::string words;
  std::string message;
  int exit_code = 2;
};

/// The tags of data/camera/tags.yaml, `times` as far out, and the first two where they are said.
std::string Tags(double times, double x10_m, double x11_m) {
  std::ostringstream text;
  text << "tags:\n- {id: 10, x_m: " << times * x10_m << ", y_m: " << times * -0.17 << "}\n"
       << "- {id: 11, x_m: " << times * x11_m << ", y_m: " << times * -0.17 << "}\n"
       << "- {id: 12, x_m: " << times * 0.24 << ", y_m: " << times * 0.17 << "}\n"
       << "- {id: 13, x_m: " << times * -0.24 << ", y_m: " << times * 0.17 << "}\n";
  return text.str();
}

void Prepare(const test::TemporaryFolder& folder) {
  const std::map<std::string, std::string> texts{
      {"mm.yaml", "waypoints: [{x: -282, y: -65}, {x: 383, y: -60, stop: true}]\n"},
      {"arena.yaml",
       "waypoints: [{x: 0, y: 0}, {x: 1, y: 0, stop: true}]\ntrial: {arena: {x_max_m: 0.5}}\n"},
      {"broken.yaml", "waypoints: [\n"},
      {"none.yaml", "name: x\n"},
      {"program.yaml",
       "candidate: {kind: program, run: [nosuchprogram, '{out}']}\nspace: {mu: [1]}\n"},
      {"beside.yaml", "candidate: {kind: program, run: [./gone.sh, '{out}']}\nspace: {mu: [1]}\n"},
      {"plain.yaml", "candidate: {kind: program, run: [plain.yaml, '{out}']}\nspace: {mu: [1]}\n"},
      {"swapped.yaml", Tags(1, 0.24, -0.24)},
      {"cm.yaml", Tags(100, -0.24, 0.24)},
      {"twice.yaml", "tags:\n- {id: 10, x_m: 0, y_m: 0}\n- {id: 10, x_m: 1, y_m: 0}\n"},
      {"alone.yaml", "tags:\n- {id: 10, x_m: 0, y_m: 0}\n"},
      {"video.mp4", "no video"},
      {"other/experiment.yaml", "name: other\n"},
      {"run/trajectory.csv", "t_s,x_m,y_m\n"},
      {"run/experiment.yaml", "name: run\n"},
      {"swept/table.csv",
       "trial,gap_m,falsified,status,u,exact_gap_m,mean_error_m,rms_error_m,start_offset_m,"
       "start_aligned_gap_m,shape_gap_m,length_ratio,end_error_m,way_gap_m,left_m,reason,"
       "candidate,reference,seed,id\n1,,,fell,,,,,,,,,,,,,,,,1\n"},
      {"swept/experiment.yaml", "name: swept\n"},
      {"damaged/table.csv", "id,gap_m,status\n1,,fell\n"},
      {"empty.csv", ""},
      {"odd.csv", "a,b\n"},
      {"picture.csv", std::string("\x89PNG\r\0\0\n1,2\n", 12)},
      {"cell.csv", "t_s,x_m,y_m,yaw_rad\n0,0,0,0\n1,x,0,0\n"},
      {"there.svg", "x"},
      {"there.json", "x"},
      {"there.csv", "x"}};
  fs::create_directories(folder / "dir");
  for (const auto& [name, text] : texts) {
    fs::create_directories(fs::path(folder / name).parent_path());
    test::WriteText(folder / name, text);
  }
}

std::vector<std::string> Split(const std::string& words, const test::TemporaryFolder& folder) {
  std::istringstream text(words);
  std::vector<std::string> split;
  for (std::string word; text >> word;) {
    if (word == "''") word.clear();
    if (word == "'_'") word = " ";
    for (const auto& [sign, meant] :
         {std::pair{'@', folder / ""}, std::pair{'%', test::SourceDir() + "/"}}) {
      if (const size_t at = word.find(sign); at != word.npos) word.replace(at, 1, meant);
    }
    split.push_back(word);
  }
  return split;
}

std::set<std::string> FilesIn(const test::TemporaryFolder& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder.Path())) {
    names.insert(entry.path().string());
  }
  return names;
}

void Check(const std::vector<WrongInput>& table) {
  const test::TemporaryFolder folder;
  Prepare(folder);
  const std::set<std::string> before = FilesIn(folder);
  for (const WrongInput& wrong : table) {
    const test::ProcessResult result = test::RunRift(Split(wrong.words, folder), "</dev/null");
    INFO("rift " << wrong.words << "\n" << result.err);
    CHECK(result.exit_code == wrong.exit_code);
    CHECK(result.out.empty());
    CHECK_THAT(result.err, Contains(wrong.message));
    CHECK_THAT(result.err, Contains("rift: ") && !Contains("filesystem error"));
    CHECK(FilesIn(folder) == before);
  }
}

const std::string kTask = " %configs/waypoints/paper.yaml ";
const std::string kLogs = " %data/example/simulator.csv %data/example/robot1.csv ";
const std::string kFilm =
    "track --camera %data/camera/frames/*.jpg --fps 15 --calibration %data/camera/camera.yaml "
    "--out @l.csv ";
const std::string kLong(300, 'n');

TEST_CASE("Wrong input: rift") {
  Check({
      {"sweeep", "did you mean 'sweep'?"},
      {"swim", "no subcommand"},
      {"elp", "did you mean 'help'?"},
      {"help sweeep", "did you mean 'sweep'?"},
      {"help simulate gap", "help takes one subcommand"},
      {"--versin", "did you mean --version?"},
      {"--verbose", "has no flag --verbose"},
      {"-x", "has no flag -x"},
      {"configs/waypoints/paper.yaml", "no subcommand; there are"},
  });
}

TEST_CASE("Wrong input: rift simulate") {
  Check({
      {"simulate", "EXPERIMENT is missing"},
      {"simulate @gone.yaml", "cannot read"},
      {"simulate @dir", "Is a directory"},
      {"simulate @broken.yaml", "broken.yaml:2:1"},
      {"simulate @none.yaml", "it has no waypoints"},
      {"simulate @mm.yaml", "divide millimetres by 1000, or give --any-waypoints"},
      {"simulate @arena.yaml", "waypoints[1] at x 1 m, y 0 m lies outside trial.arena"},
      {"simulate" + kTask + "@mm.yaml", "one argument too many"},
      {"simulate" + kTask + "--sed 3", "has no flag --sed; did you mean --se"},
      {"simulate" + kTask + "--ouut @x", "did you mean --out?"},
      {"simulate" + kTask + "--seed", "--seed needs its value, N; rift simulate --help"},
      {"simulate" + kTask + "--seed abc", "must be a whole number"},
      {"simulate" + kTask + "--seed -1", "must be in [0"},
      {"simulate" + kTask + "--set v_min", "must be key=value"},
      {"simulate" + kTask + "--set control.v_mni=1", "did you mean 'control.v_min'"},
      {"simulate" + kTask + "--set control.v_min=9", "must be in [0, 1]"},
      {"simulate" + kTask + "--start 1,2", "give X,Y,YAW_DEG"},
      {"simulate" + kTask + "--start a,b,c", "must be a number"},
      {"simulate" + kTask + "--out @l.csv --figure @x.pdf", "must end in .svg or .png"},
      {"simulate" + kTask + "--out @l.csv --figure @gone/x.svg", "there is no folder"},
      {"simulate" + kTask + "--out @l.csv --figure @there.svg", "give --force"},
      {"simulate" + kTask + "--out @l.csv --video @x.avi", "must end in .mp4"},
      {"simulate" + kTask + "--out @l.csv --tum @dir", "is a folder: name a file"},
      {"simulate" + kTask + "--out @gone/l.csv", "there is no folder"},
      {"simulate" + kTask + "--out @there.csv", "there.csv is there already"},
      {"simulate" + kTask + "--out @run", "trajectory.csv is there already"},
      {"simulate" + kTask + "--out @swept", "holds a sweep"},
      {"simulate" + kTask + "--out @there.svg", "is a file"},
      {"simulate" + kTask + "--out " + kLong, "File name too long", 3},
      {"simulate" + kTask + "--out - --json", "both stdout"},
      {"simulate" + kTask + "--out - --tum -", "- is stdout"},
      {"simulate" + kTask + "--twin --json", "--twin excludes --json"},
      {"simulate" + kTask + "--seed ''", "--seed: its value is empty: give one, or leave it out"},
      {"simulate" + kTask + "--out ''", "--out: its value is empty"},
      {"simulate" + kTask + "--start ''", "--start: its value is empty"},
      {"simulate ''", "EXPERIMENT: its value is empty"},
      {"simulate" + kTask + "--out=~/run",
       "the shell replaces ~ neither within quotes nor after ="},
      {"simulate" + kTask + "--seed 1 --seed 2", "--seed is given 2 times: give it once"},
      {"simulate" + kTask + "--view=yes", "--view takes no value: leave out what follows ="},
      {"simulate" + kTask + "--out @run.json", "is the name of a file"},
      {"simulate @a.yaml @b.yaml @c.yaml", "and 1 more are too many arguments"},
      {"simulate --replay @swept", "--replay takes 2 values, DIR ID|worst, and 1 is given"},
      {"simulate --replay @dir 1", "table.csv"},
      {"simulate --replay @swept 7", "no row with id 7"},
      {"simulate --replay @swept worst", "has no row with a gap"},
      {"simulate --replay @damaged 1", "its header does not name the column trial once"},
      {"simulate --replay @swept 1 --seed 3", "leave EXPERIMENT, --set, --start, --seed out"},
      {"simulate --replay @swept 1 --start 0,0,0", "leave EXPERIMENT, --set, --start"},
      {"simulate --replay @swept 1 --set seed=3", "leave EXPERIMENT, --set"},
      {"simulate" + kTask + "--replay @swept 1", "leave EXPERIMENT"},
      {"simulate" + kTask + "--twin --out @swept", "holds a sweep"},
      {"simulate" + kTask + "--twin --out @twin.csv", "a twin's run is a folder of files"},
      {"simulate" + kTask + "--set name=../a", "'../a', is no folder name: say --out DIR"},
  });
}

TEST_CASE("Wrong input: rift gap") {
  Check({
      {"gap", "SIM is required; rift gap --help"},
      {"gap %data/example/simulator.csv", "REAL is required"},
      {"gap @gone.csv %data/example/robot1.csv", "cannot read"},
      {"gap %data/example/simulator.csv @dir", "Is a directory"},
      {"gap @empty.csv %data/example/robot1.csv", "the file is empty"},
      {"gap @odd.csv %data/example/robot1.csv", "odd.csv:1"},
      {"gap @picture.csv %data/example/robot1.csv",
       "picture.csv: is not text: a log is a table of numbers in text"},
      {"gap %configs/waypoints/paper.yaml %data/example/robot1.csv", "belongs to no dialect"},
      {"gap" + kLogs + "--real-format tracker",
       "robot1.csv: its header is of dialect rift, and the format asked for is tracker"},
      {"gap" + kLogs + "--real-format tum", "leave it at auto"},
      {"gap" + kLogs + "--sim-columns t=a,x=b", "--sim-columns: y is missing in 't=a,x=b'"},
      {"gap" + kLogs + "--units furlong", "--units: 'furlong' is none of m, cm, mm"},
      {"gap" + kLogs + "--real-units furlong", "--real-units: 'furlong' is none of m, cm, mm"},
      {"gap" + kLogs + "--real-units mm --real-format rift", "leave out either"},
      {"gap" + kLogs + "--window 1", "--window is for runs held together with their encoders"},
      {"gap @cell.csv %data/example/robot1.csv", "cell.csv:3: column x_m is 'x'"},
      {"gap" + kLogs + "%data/example/robot1.csv", "name it once"},
      {"gap" + kLogs + "--figur @x.svg", "did you mean --figure?"},
      {"gap" + kLogs + "--figure @x.pdf", "must end in .svg or .png"},
      {"gap" + kLogs + "--profile @x.csv --figure @x.pdf", "must end in .svg or .png"},
      {"gap" + kLogs + "--figure @gone/x.svg", "mend the name, or make the folder"},
      {"gap" + kLogs + "--figure @there.svg", "give --force to replace it"},
      {"gap" + kLogs + "--json @there.json", "give --force to replace it"},
      {"gap" + kLogs + "--json @dir", "is a folder: name a file"},
      {"gap" + kLogs + "--json - --profile -", "both stdout"},
      {"gap" + kLogs + "--json @x --profile @x", "is an input or another output"},
      {"gap" + kLogs + "--profile %data/example/robot1.csv", "is an input or another output"},
      {"gap" + kLogs + "--threshold abc", "'abc' must be a number"},
      {"gap" + kLogs + "--threshold -1", "must be a number in [0"},
      {"gap" + kLogs + "--samples 1.5", "--samples: '1.5' must be a whole number in [2"},
      {"gap" + kLogs + "--samples 1e3", "--samples: '1e3' must be a whole number"},
      {"gap" + kLogs + "--threshold ''", "--threshold: its value is empty"},
      {"gap" + kLogs + "--threshold", "--threshold needs its value, m; rift gap --help"},
      {"gap" + kLogs + "''", "REAL: its value is empty"},
      {"gap" + kLogs + "~/real.csv", "write $HOME/real.csv"},
      {"gap" + kLogs + "--exit-code=no", "--exit-code takes no value"},
      {"gap" + kLogs + "--tag-offset nan", "must be a number in [-1, 1]"},
      {"gap" + kLogs + "--real-format foo", "auto,rift,tum,tracker,webots"},
      {"gap" + kLogs + "--real-format webots", "rift"},
      {"gap" + kLogs + "--sim-repeats @gone.csv", "cannot read"},
      {"gap" + kLogs + "--odometry", "has neither encoders"},
      {"gap" + kLogs + "--odometry --figure @x.svg", "leave them out with --odometry"},
      {"gap" + kLogs + "--odometry --profile @x.csv", "leave them out with --odometry"},
      {"gap" + kLogs + "--slip-bins 5", "--slip-bins is for runs held together"},
      {"gap" + kLogs + "--moved-share 0.5", "--moved-share is for runs held together"},
      {"gap" + kLogs + "--tag-ahead 0.1", "--tag-ahead is for runs held together"},
      {"gap" + kLogs + "--sim-repeats @cell.csv --json @cell.csv --force", "is an input"},
      {"gap" + kLogs + "--program @gone.yaml", "cannot read"},
  });
}

TEST_CASE("Wrong input: rift sweep") {
  const std::string out = " --out @new ";
  Check({
      {"sweep", "EXPERIMENT is missing"},
      {"sweep @gone.yaml" + out, "cannot read"},
      {"sweep @dir" + out, "Is a directory"},
      {"sweep @broken.yaml" + out, "broken.yaml:2:1"},
      {"sweep @mm.yaml" + out, "--any-waypoints"},
      {"sweep @arena.yaml" + out, "lies outside trial.arena"},
      {"sweep" + kTask + out + "extra", "one argument too many"},
      {"sweep" + kTask + out + "--buget 3", "did you mean --budget?"},
      {"sweep" + kTask + out + "--budget 3", "limit a search"},
      {"sweep" + kTask + out + "--seconds 3", "limit a search"},
      {"sweep" + kTask + out + "--jobs 0", "--jobs: '0' must be a whole number in [1, 4096]"},
      {"sweep" + kTask + out + "--jobs many", "--jobs: 'many' must be a whole number"},
      {"sweep" + kTask + out + "--suggest 0", "--suggest: '0' must"},
      {"sweep" + kTask + out + "--suggest 1001",
       "--suggest: '1001' must be a whole number in [1, 1000]"},
      {"sweep" + kTask + out + "--engine slurm --shards 0",
       "--shards: '0' must be a whole number in [1, 1000000]"},
      {"sweep" + kTask + out + "--shards 2", "--shards is for --engine slurm"},
      {"sweep" + kTask + out + "--partition night", "--partition is for --engine slurm"},
      {"sweep" + kTask + out + "--copy-every 0.9", "must be a number in [1, 86400]"},
      {"sweep" + kTask + out + "--shrink first", "must be the id of a row"},
      {"sweep" + kTask + out + "--write-robot @r.yaml", "needs goal: calibrate"},
      {"sweep" + kTask + out +
           "--set goal=calibrate --set reference.kind=logs --set reference.path=x.csv --set "
           "calibrate.fit={\"motor.mismatch\":{\"min\":-0.1,\"max\":0.1}} --write-robot "
           "@new/calibration.json",
       "new/calibration.json is an input or another output"},
      {"sweep" + kTask + out + "--set space.v_mi=[1,2]", "did you mean 'control.v_min'?"},
      {"sweep" + kTask + out + "--set space.v_min=[]", "an axis needs at least one value"},
      {"sweep" + kTask + out + "--set goal=find", "must be one of grid, falsify, calibrate"},
      {"sweep" + kTask + out + "--set reference.kind=logs", "reference.path is missing"},
      {"sweep" + kTask + out + "--set candidate.kind=logs", "candidate.path is missing"},
      {"sweep" + kTask + out + "--json --brief", "--brief excludes --json"},
      {"sweep" + kTask + out + "--quiet --json-progress", "--quiet excludes --json-progress"},
      {"sweep" + kTask + out +
           "--set goal=falsify --set space={\"v_min\":{\"min\":0.3,\"max\":0.1}}",
       "min is 0.3, and it must be below max, which is 0.1"},
      {"sweep" + kTask + out + "--set reference.kind=logs --set reference.path='{sruface}.csv'",
       "reference.path: path '"},
      {"sweep" + kTask + out + "--set reference.kind=logs --set reference.path='{surface.csv'",
       "has a brace without its partner"},
      {"sweep @program.yaml" + out, "candidate.run: there is no program 'nosuchprogram' in PATH"},
      {"sweep @beside.yaml" + out, "candidate.run: there is no program ./gone.sh"},
      {"sweep @plain.yaml" + out, "plain.yaml is not executable: chmod +x it"},
      {"sweep" + kTask + "--out -", "name a folder"},
      {"sweep" + kTask + "--out @new.json", "is the name of a file, and a sweep is a folder"},
      {"sweep" + kTask + "--out ''", "--out: its value is empty"},
      {"sweep" + kTask + out + "--jobs ''", "--jobs: its value is empty"},
      {"sweep" + kTask + out + "--serve=8080", "--serve takes no value"},
      {"sweep --compare @dir", "--compare takes 2 values, DIR, and 1 is given"},
      {"sweep" + kTask + "--out @there.svg", "is a file"},
      {"sweep" + kTask + "--out @run", "holds a run: name another folder"},
      {"sweep" + kTask + "--out @other", "holds another experiment"},
      {"sweep" + kTask + "--status", "--status needs its value, DIR"},
      {"sweep --status @dir", "no such file; a sweep of simulated trials"},
      {"sweep --status @dir --exit-code", "--exit-code does not go with --status"},
      {"sweep --status @dir --page @x.html", "--page does not go with --status"},
      {"sweep" + kTask + "--status @dir", "EXPERIMENT does not go with --status"},
      {"sweep --compare @dir @dir --exit-code", "--exit-code does not go with --compare"},
      {"sweep --compare @dir @dir --set seed=2", "--set does not go with --compare"},
      {"sweep --compare @dir @dir --force --page @x.html", "is not the folder of a finished sweep"},
  });
}

TEST_CASE("Wrong input: rift track") {
  const std::string board = "track --calibrate --images @dir ";
  const std::string camera = "track --calibration %data/camera/camera.yaml --out @l.csv --camera ";
  Check({
      {"track", "--camera is missing: name a device"},
      {"track --camera @x", "--calibration is missing"},
      {"track --camera @x --calibration %data/camera/camera.yaml", "--out LOG.csv is missing"},
      {"track --camera @x --calibration @gone.yaml --out @l.csv", "cannot read"},
      {"track --camera @x --calibration @broken.yaml --out @l.csv", "broken.yaml:2:1"},
      {"track --camera @no*.jpg --calibration %data/camera/camera.yaml --out @l.csv",
       "matches no picture"},
      {camera + "@video.mp4", "FFmpeg cannot open it: is it a video?"},
      {camera + "127.0.0.1:8080/video", "the address of a camera begins with http://"},
      {camera + "http://", "it is no address of a camera"},
      {camera + "http://camera:99999/video", "a port up to 65535"},
      {kFilm + "--fsp 3", "did you mean --fps?"},
      {kFilm + "--id 3,3", "3 is named twice"},
      {kFilm + "--id 999", "tag id 999: the family tag36h11 has the ids 0 to 586"},
      {kFilm + "--id a", "--id: 'a' must be a whole number in [0, 2114]"},
      {kFilm + "--id ''", "--id: its value is empty"},
      {kFilm + "--tag-height 9", "must be a number in [0, 2]"},
      {kFilm + "--duration -3", "--duration: '-3'"},
      {kFilm + "--images @dir", "belong to --calibrate"},
      {kFilm + "--world @gone.yaml", "cannot read"},
      {kFilm + "--world @swapped.yaml", "swapped.yaml: the places of the points do not fit"},
      {kFilm + "--world @swapped.yaml", "sees, from no place above the floor (limit 5 mm)"},
      {kFilm + "--world @cm.yaml", "the places are centimetres: x_m and y_m are metres"},
      {kFilm + "--world @twice.yaml",
       "twice.yaml:3:8: key 'tags[].id' is 10: this tag has a place already"},
      {kFilm + "--world @alone.yaml", "needs 4 reference tags or more, and the file names 1"},
      {kFilm + "--path @gone.csv", "cannot read"},
      {kFilm + "--times @gone.txt", "cannot read"},
      {kFilm + "--set track.tag.id=a", "must be a whole number"},
      {kFilm + "--record-waypoints @there.json", "give --force to replace it"},
      {"track --camera %data/camera/frames/*.jpg --calibration %data/camera/camera.yaml --out "
       "@gone/l.csv",
       "there is no folder"},
      {"track --camera %data/camera/frames/*.jpg --calibration %data/camera/camera.yaml --out "
       "@there.csv",
       "give --force to replace it"},
      {"track --camera %data/camera/frames/*.jpg --calibration %data/camera/camera.yaml --out "
       "%data/camera/frames/000.jpg",
       "one of the camera's pictures"},
      {"track --calibrate --out @c.yaml", "either --images DIR or --camera"},
      {board, "--out CAM.yaml is missing"},
      {board + "--out @c.yaml", "matches no picture"},
      {board + "--out @there.json", "give --force to replace it"},
      {board + "--out @c.yaml --picture @there.svg", "give --force to replace it"},
      {board + "--out @c.yaml --board 13", "--board '13'"},
      {board + "--out @c.yaml --board 1x1", "there must be 3 to 100 both ways"},
      {board + "--out @c.yaml --square 25mm", "--square: '25mm' must be a number, in m"},
      {board + "--out @c.yaml --square 0", "the side of one square in metres"},
  });
}

TEST_CASE("Wrong input: rift drive") {
  const std::string rest = " --port @gone --camera x --calibration %data/camera/camera.yaml ";
  Check({
      {"drive", "--port is missing"},
      {"drive" + kTask, "--port is missing"},
      {"drive" + kTask + "--prot @x", "did you mean --port?"},
      {"drive" + kTask + "--port @gone", "--camera is missing"},
      {"drive" + kTask + "--port @gone --camera x", "--calibration is missing"},
      {"drive --port @gone --camera x --calibration x", "EXPERIMENT is missing"},
      {"drive @gone.yaml" + rest, "cannot read"},
      {"drive @none.yaml" + rest, "none.yaml: "},
      {"drive @mm.yaml" + rest, "--any-waypoints"},
      {"drive @arena.yaml" + rest, "lies outside trial.arena"},
      {"drive" + kTask + rest + "--out @run", "holds a run already"},
      {"drive" + kTask + rest + "--out @swept", "holds a sweep"},
      {"drive" + kTask + rest + "--out -", "name a folder"},
      {"drive" + kTask + rest + "--out @log.csv", "is the name of a file, and a drive is a folder"},
      {"drive" + kTask + rest + "--port @x", "--port is given 2 times: give it once"},
      {"drive" + kTask + rest + "--out @new", "stdin is no terminal"},
      {"drive" + kTask + rest + "--countdown 99", "must be a number in [0, 60]"},
      {"drive" + kTask + rest + "--seconds 3", "--seconds requires --dry-run"},
      {"drive" + kTask + rest + "--before-each true",
       "goes with --repeat, --grid, --identify or --suggested"},
      {"drive" + kTask + rest + "--repeat 0", "--repeat: '0' must"},
      {"drive" + kTask + "--before-each true", "--port is missing"},
      {"drive" + kTask + "--repeat 2", "--port is missing"},
      {"drive" + kTask + "--repeat 2 --before-each '_' --out @new", "is blank: name the program"},
      {"drive" + kTask + "--identify --repeat 1 --port @gone", "a fit needs at least 2 drives"},
      {"drive" + kTask + rest + "--repeat 2 --tum @x.tum", "are copies of one drive's log"},
      {"drive" + kTask + rest + "--force", "--force is for --video, --tum and --mcap"},
      {"drive" + kTask + rest + "--repeat 2 --grid", "--repeat excludes --grid"},
      {"drive --ping", "--port is missing"},
      {"drive --ping --port @x --set hardware.line.baud=9", "name EXPERIMENT, its YAML file"},
      {"drive --ping --port @gone --repeat 2", "--ping excludes --repeat"},
      {"drive --ping --port @gone --dry-run", "--ping excludes --dry-run"},
      {"drive --ping --port @gone --view", "--view excludes --ping"},
      {"drive --ping --port @gone --out @new", "--out excludes --ping"},
      {"drive --ping --port @gone", "there is no serial port", 3},
      {"drive --ping --port @there.svg", "is no serial port", 3},
      {"drive --replay @dir", "holds no drive"},
      {"drive --replay @run --video @x.avi", "must end in .mp4"},
      {"drive --replay @run --video @gone/x.mp4", "there is no folder"},
      {"drive --replay @run --json", "--json excludes --replay"},
      {"drive --replay @run --dry-run", "--dry-run excludes --replay"},
      {"drive --replay @run --repeat 2", "--repeat excludes --replay"},
      {"drive --replay @run --any-start", "--any-start excludes --replay"},
      {"drive --video @x.mp4", "--video requires --replay"},
  });
}

TEST_CASE("Bare rift, rift help, -v and rift help COMMAND answer on stdout") {
  const test::ProcessResult bare = test::RunRift({});
  CHECK(bare.exit_code == 0);
  CHECK(bare.err.empty());
  for (const std::string name : {"simulate", "track", "drive", "gap", "sweep"}) {
    CHECK_THAT(bare.out, Contains("\n  rift " + name + " "));  // an example of each
  }
  CHECK(test::RunRift({"help"}).out == bare.out);
  CHECK(test::RunRift({"--help"}).out == bare.out);
  CHECK(test::RunRift({"help", "gap"}).out == test::RunRift({"gap", "--help"}).out);
  const std::string version = test::RunRift({"-v"}).out;
  CHECK(version == test::RunRift({"--version"}).out);
  for (const std::string word : {"rift ", "commit: ", "ODE 0.", "OpenCV 4."}) {
    CHECK_THAT(version, Contains(word));
  }
}

TEST_CASE(
    "A log and a profile go to stdout: --out - and --profile - are the log and the profile, and "
    "nothing else") {
  const test::TemporaryFolder folder;
  const std::string task = test::SourceDir() + "/configs/waypoints/paper.yaml";
  REQUIRE(test::RunRift({"simulate", task, "--out", folder / "l.csv"}).exit_code == 0);
  const test::ProcessResult piped = test::RunRift({"simulate", task, "--out", "-"});
  CHECK(piped.exit_code == 0);
  CHECK(piped.out == test::ReadFile(folder / "l.csv"));
  const std::string example = test::SourceDir() + "/data/example/";
  const std::vector<std::string> gap{"gap", example + "simulator.csv", example + "robot1.csv",
                                     "--profile"};
  auto to_file = gap, to_stdout = gap;
  to_file.push_back(folder / "p.csv");
  to_stdout.emplace_back("-");
  REQUIRE(test::RunRift(to_file).exit_code == 0);
  CHECK(test::RunRift(to_stdout).out == test::ReadFile(folder / "p.csv"));
}

TEST_CASE("Files that are there are replaced with --force, and by the same run again") {
  const test::TemporaryFolder folder;
  const std::string task = test::SourceDir() + "/configs/waypoints/paper.yaml";
  const std::vector<std::string> run{"simulate", task, "--out", folder / "run"};
  REQUIRE(test::RunRift(run).exit_code == 0);
  const std::string log = test::ReadFile(folder / "run/trajectory.csv");
  CHECK(test::RunRift(run).exit_code == 0);
  auto other = run;
  other.insert(other.end(), {"--seed", "2"});
  CHECK(test::RunRift(other).exit_code == 2);
  CHECK(test::ReadFile(folder / "run/trajectory.csv") == log);
  other.emplace_back("--force");
  CHECK(test::RunRift(other).exit_code == 0);
  CHECK(test::ReadFile(folder / "run/trajectory.csv") != log);
}

TEST_CASE("A brief sweep answers five questions in five lines, from the run's own counts") {
  const test::QuickGnuplot gnuplot;
  const test::TemporaryFolder folder;
  const test::ProcessResult sweep = test::RunRift(
      {"sweep", test::SourceDir() + "/data/example/demo.yaml", "--set", "reference.trials=6",
       "--set", "space.control.v_min=[0.2]", "--out", folder / "s", "--brief", "--quiet"});
  INFO(sweep.out << sweep.err);
  REQUIRE(sweep.exit_code == 0);
  std::istringstream lines(sweep.out);
  for (const std::string label : {"what fails:", "where:", "why:", "how sure:", "what next:"}) {
    std::string line;
    REQUIRE(std::getline(lines, line));
    CHECK(line.starts_with(label));
  }
  CHECK_THAT(sweep.out, Contains("of 36 runs exceed 0.06 m, and ") &&
                            Contains("processing_s 0.25, v_min 0.2 (6 of 6 failed)"));
}

TEST_CASE("The worst row of a sweep is driven again by its name") {
  const test::QuickGnuplot gnuplot;
  const test::TemporaryFolder folder;
  const std::string out = folder / "sweep";
  const test::ProcessResult sweep =
      test::RunRift({"sweep", test::SourceDir() + "/configs/waypoints/paper.yaml", "--set",
                     "space={surface: [ground, parchment], v_min: [0.14, 0.16]}", "--out", out});
  REQUIRE(sweep.exit_code == 0);
  const test::ProcessResult worst = test::RunRift({"simulate", "--replay", out, "worst"});
  INFO(worst.err);
  REQUIRE(worst.exit_code == 0);
  const std::string row = worst.err.substr(worst.err.find("row "), worst.err.find(": status") - 6);
  CHECK_THAT(sweep.out, Contains("worst: " + row.substr(0, row.find(':')) + ", "));
}

}  // namespace
}  // namespace rift
