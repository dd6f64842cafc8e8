#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace rift {
namespace {

namespace fs = std::filesystem;

using Rooms = std::set<std::string>;

/// The rooms that a room names in the plan; it may include them and the rooms they name.
const std::map<std::string, Rooms> kRooms{
    {"geometry", {}},
    {"trajectory", {"geometry"}},
    {"robot", {"geometry"}},
    {"module", {}},
    {"vision", {"geometry", "module"}},
    {"gap", {"trajectory"}},
    {"control", {"robot", "geometry"}},
    {"trial", {"robot", "control", "trajectory"}},
    {"simulation", {"robot"}},
    {"hardware", {"robot", "vision"}},
    {"twin", {"simulation", "hardware", "vision", "trial"}},
    {"search", {}},
    {"sweep", {"trial", "simulation", "gap", "trajectory", "search"}},
    {"report", {"gap", "sweep", "trajectory"}},
    {"view", {"geometry", "trajectory", "robot", "module"}},
    {"config",
     {"geometry", "trajectory", "robot", "vision", "gap", "control", "trial", "simulation",
      "hardware", "twin", "search", "sweep", "report"}},
    {"commands",
     {"geometry", "trajectory", "robot", "vision", "gap", "control", "trial", "simulation",
      "hardware", "twin", "search", "sweep", "report", "config", "view"}},
};

/// Headers that only one room may see, so that a library can be exchanged in one place, and
/// headers that computation has no business with.
struct Reserved {
  std::string pattern;
  Rooms rooms;
};
const std::vector<Reserved> kReserved{
    {"yaml-cpp/.*", {"config"}},
    {"ode/.*", {"simulation"}},
    {"apriltag.*", {"vision"}},
    {"opencv2/(videoio|imgcodecs|highgui).*", {"vision", "commands", "view"}},
    {"CLI/.*", {"commands"}},
    {"pagmo/.*|nlopt.*", {"search"}},
    {"turbojpeg.h", {"vision"}},
    {"dlfcn.h|xcb/.*", {"module"}},
    {"sqlite3.*|SQLiteCpp/.*", {"sweep"}},
    {"termios.h|asm/termbits.h|boost/asio.*", {"hardware", "twin"}},
    {"fstream|iostream|cstdio", {"commands", "hardware", "vision", "twin", "report"}},
    {"thread|mutex|condition_variable", {"commands", "hardware", "vision", "twin", "sweep"}},
    {"future", {"commands", "hardware", "vision", "twin", "sweep", "gap"}},
};

struct Include {
  std::string room;  ///< of the file that includes
  std::string target;
  std::string where;  ///< file:line
};

/// The first folder of a file below src or include/rift; main.cpp is the outermost room.
std::string RoomOf(const fs::path& relative) {
  return relative.has_parent_path() ? relative.begin()->string() : "main";
}

std::vector<Include> AllIncludes() {
  static const std::regex kInclude(R"(\s*#\s*include\s*[<"]([^>"]+)[>"].*)");
  std::vector<Include> includes;
  for (const char* top : {"src", "include/rift"}) {
    const fs::path root = fs::path(RIFT_SOURCE_DIR) / top;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root)) {
      if (!entry.is_regular_file()) continue;
      const std::string extension = entry.path().extension().string();
      if (extension != ".hpp" && extension != ".cpp") continue;
      std::ifstream file(entry.path());
      std::string line;
      for (int number = 1; std::getline(file, line); ++number) {
        std::smatch match;
        if (!std::regex_match(line, match, kInclude)) continue;
        includes.push_back({RoomOf(fs::relative(entry.path(), root)), match[1].str(),
                            entry.path().string() + ":" + std::to_string(number)});
      }
    }
  }
  return includes;
}

/// A room, those it names, and those they name.
Rooms Reachable(const std::string& room) {
  Rooms reached{room};
  std::function<void(const std::string&)> visit = [&](const std::string& from) {
    for (const std::string& next : kRooms.at(from)) {
      if (reached.insert(next).second) visit(next);
    }
  };
  if (room == "main") return {"commands", "config"};
  visit(room);
  return reached;
}

TEST_CASE("Every room includes only the rooms that the plan allows it") {
  const std::vector<Include> includes = AllIncludes();
  REQUIRE(includes.size() > 50);
  for (const Include& include : includes) {
    if (!include.target.starts_with("rift/")) continue;
    INFO(include.where << " includes " << include.target);
    REQUIRE((include.room == "main" || kRooms.contains(include.room)));
    const std::string target = RoomOf(fs::path(include.target).lexically_relative("rift"));
    CHECK(Reachable(include.room).contains(target));
  }
}

TEST_CASE("A library is seen only by the room that owns it") {
  for (const Include& include : AllIncludes()) {
    if (include.room == "main") continue;
    for (const Reserved& reserved : kReserved) {
      if (!std::regex_match(include.target, std::regex(reserved.pattern))) continue;
      INFO(include.where << " includes " << include.target);
      CHECK(reserved.rooms.contains(include.room));
    }
  }
}

TEST_CASE("The plan itself keeps simulator and hardware apart") {
  CHECK_FALSE(Reachable("simulation").contains("hardware"));
  CHECK_FALSE(Reachable("hardware").contains("simulation"));
  CHECK_FALSE(Reachable("control").contains("vision"));
  CHECK_FALSE(Reachable("control").contains("simulation"));
  CHECK_FALSE(Reachable("gap").contains("control"));
  for (const char* room : {"control", "trial"}) {
    CHECK_FALSE(Reachable(room).contains("simulation"));
    CHECK_FALSE(Reachable(room).contains("hardware"));
  }
}

}  // namespace
}  // namespace rift
