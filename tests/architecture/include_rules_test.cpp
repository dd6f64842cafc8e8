#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "support/documented.hpp"
#include "support/tree.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;

using Rooms = std::set<std::string>;

/// What a room may include besides itself, as cmake/rooms.cmake says.
struct Allowed {
  Rooms rooms;
  Rooms options;  ///< of these only the headers that hold options
};

/// The table of cmake/rooms.cmake: lines `name: room room; room room`.
std::map<std::string, Allowed> ReadTable() {
  std::map<std::string, Allowed> table;
  std::ifstream file(test::BuildDir() + "/generated/rooms.txt");
  for (std::string line; std::getline(file, line);) {
    const size_t colon = line.find(':'), semicolon = line.find(';');
    const auto names = [&](size_t from, size_t to) {
      std::istringstream words(line.substr(from, to - from));
      return Rooms(std::istream_iterator<std::string>(words), {});
    };
    table[line.substr(0, colon)] = {names(colon + 1, semicolon),
                                    names(semicolon + 1, std::string::npos)};
  }
  return table;
}

/// Headers that only one room may see, so that a library can be exchanged in one place, and
/// headers that computation has no business with.
struct Reserved {
  std::string pattern;
  Rooms rooms;
};
const std::vector<Reserved> kReserved{
    {"yaml-cpp/.*", {"yaml"}},
    {"ode/.*", {"simulation"}},
    {"apriltag.*", {"vision/tracking"}},
    {"opencv2/(videoio|imgcodecs|highgui).*", {"vision", "view"}},
    {"CLI/.*", {"commands", "flags"}},
    {"pagmo/.*|nlopt.*", {"search"}},
    {"boost/math/.*|xxhash.h", {"statistics"}},
    {"turbojpeg.h", {"vision"}},
    {"xcb/.*", {"view"}},
    {"sqlite3.*|SQLiteCpp/.*", {"sweep/run"}},
    {"termios.h|asm/termbits.h", {"hardware", "twin"}},
    {"boost/asio.*", {"hardware", "twin", "sessions/sweep"}},
    {"fstream|iostream|cstdio",
     {"commands", "files", "hardware", "report", "terminal", "twin", "vision"}},
    {"thread|mutex|condition_variable|future",
     {"commands", "files", "hardware", "sessions", "vision", "twin", "sweep"}},
};

struct Include {
  std::string room;  ///< of the file that includes
  std::string target;
  std::string where;  ///< file:line
};

/// The folder of a file below src or include/rift; main.cpp is the outermost room.
std::string RoomOf(const fs::path& relative) {
  return relative.has_parent_path() ? relative.parent_path().generic_string() : "main";
}

bool IsIn(const std::string& room, const Rooms& rooms) {
  return rooms.contains(room) || rooms.contains(room.substr(0, room.find('/')));
}

bool HoldsOptions(const std::string& header) { return header.ends_with("options.hpp"); }

std::vector<Include> AllIncludes() {
  static const std::regex kInclude(R"(\s*#\s*include\s*[<"]([^>"]+)[>"].*)");
  std::vector<Include> includes;
  for (const char* top : {"src", "include/rift"}) {
    const fs::path root = fs::path(test::SourceDir()) / top;
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

TEST_CASE("Every room includes only the rooms that cmake/rooms.cmake allows it") {
  const std::map<std::string, Allowed> table = ReadTable();
  const std::vector<Include> includes = AllIncludes();
  REQUIRE(table.size() > 15);
  REQUIRE(includes.size() > 50);
  for (const Include& include : includes) {
    if (!include.target.starts_with("rift/") || include.room == "main") continue;
    INFO(include.where << " includes " << include.target);
    REQUIRE(table.contains(include.room));
    const std::string target = RoomOf(fs::path(include.target).lexically_relative("rift"));
    const Allowed& allowed = table.at(include.room);
    const bool is_options = allowed.options.contains(target) && HoldsOptions(include.target);
    CHECK((target == include.room || allowed.rooms.contains(target) || is_options));
  }
}

TEST_CASE("No room is allowed a room that it does not include") {
  std::map<std::string, Rooms> used;
  for (const Include& include : AllIncludes()) {
    if (!include.target.starts_with("rift/")) continue;
    used[include.room].insert(RoomOf(fs::path(include.target).lexically_relative("rift")));
  }
  for (const auto& [room, allowed] : ReadTable()) {
    for (const Rooms& rooms : {allowed.rooms, allowed.options}) {
      for (const std::string& other : rooms) {
        INFO(room << " may include " << other);
        CHECK(used[room].contains(other));
      }
    }
  }
}

TEST_CASE("A library is seen only by the room that owns it") {
  for (const Include& include : AllIncludes()) {
    if (include.room == "main") continue;
    for (const Reserved& reserved : kReserved) {
      if (!std::regex_match(include.target, std::regex(reserved.pattern))) continue;
      INFO(include.where << " includes " << include.target);
      CHECK(IsIn(include.room, reserved.rooms));
    }
  }
}

/// As the last column of docs/rooms.md has it.
std::string Text(const std::string& rooms, const std::string& options) {
  const auto quoted = [](const std::string& names) {
    std::istringstream words(names);
    std::string text;
    for (std::string name; words >> name;) text += (text.empty() ? "`" : ", `") + name + "`";
    return text;
  };
  std::string text = quoted(rooms);
  const std::string of = quoted(options);
  if (!of.empty()) text += (text.empty() ? "" : "; ") + ("options of " + of);
  return text.empty() ? "-" : text;
}

TEST_CASE("docs/rooms.md is the table of cmake/rooms.cmake") {
  const std::vector<test::DocumentedRoom> documented = test::DocumentedRooms();
  std::ifstream file(test::BuildDir() + "/generated/rooms.txt");
  size_t row = 0;
  for (std::string line; std::getline(file, line); ++row) {
    const size_t colon = line.find(':'), semicolon = line.find(';');
    const std::string name = line.substr(0, colon);
    const std::string may_include =
        Text(line.substr(colon + 1, semicolon - colon - 1), line.substr(semicolon + 1));
    INFO("row of docs/rooms.md: | `" << name << "` | what it holds | " << may_include << " |");
    REQUIRE(row < documented.size());
    CHECK(documented[row].name == name);
    CHECK(documented[row].may_include == may_include);
  }
  CHECK(documented.size() == row);
}

TEST_CASE("Every source file that the documents name is there") {
  int named = 0;
  for (const std::string document : {"README.md", "CONTRIBUTING.md", "docs/concepts.md",
                                     "docs/files.md", "docs/json.md", "docs/rooms.md"}) {
    std::ifstream file(test::SourceDir() + "/" + document);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    REQUIRE_FALSE(text.empty());
    static const std::regex kFile("(src|include|tests|cmake)/[a-z0-9_/]+\\.[a-z]+");
    for (std::sregex_iterator found(text.begin(), text.end(), kFile), end; found != end; ++found) {
      INFO(document << " names " << found->str());
      CHECK(std::filesystem::exists(test::SourceDir() + "/" + found->str()));
      ++named;
    }
  }
  CHECK(named > 20);
}

TEST_CASE("docs/rooms.md says of every source file what is done in it") {
  std::ifstream file(test::SourceDir() + "/docs/rooms.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  int files = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(test::SourceDir() + "/src")) {
    const std::string ending = entry.path().extension().string();
    if (ending != ".cpp" && ending != ".py") continue;
    const std::string name =
        std::filesystem::relative(entry.path(), test::SourceDir()).generic_string();
    INFO("docs/rooms.md, Where it is done: a row that ends in | `" << name << "` |");
    CHECK(text.find("| `" + name + "` |") != std::string::npos);
    ++files;
  }
  CHECK(files > 300);
}

TEST_CASE("No folder of the code holds more than 30 files of its own") {
  std::map<fs::path, int> files;
  for (const char* top : {"src", "include", "tests"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(test::SourceDir()) / top)) {
      if (entry.is_regular_file()) ++files[entry.path().parent_path()];
    }
  }
  for (const auto& [folder, count] : files) {
    INFO(folder.string() << ": a listing that fits on one screen");
    CHECK(count <= 30);
  }
  CHECK(files.size() > 60);
}

TEST_CASE("The table keeps simulator, hardware and computation apart") {
  const std::map<std::string, Allowed> table = ReadTable();
  const auto never = [&](const std::string& room, const std::string& other) {
    INFO(room << " -> " << other);
    CHECK_FALSE(IsIn(other, table.at(room).rooms));
  };
  never("simulation", "hardware");
  never("hardware", "simulation");
  never("control", "vision/camera");
  for (const char* room : {"control", "trial"}) {
    never(room, "simulation");
    never(room, "hardware");
  }
  never("gap", "control");
  never("sweep/run", "sweep/falsify");
  for (const auto& [room, allowed] : table) {
    never(room, "commands");
    if (room.starts_with("sessions/")) never(room, "terminal");
  }
}

}  // namespace
}  // namespace rift
