#include "flag_contract.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <iterator>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "support/help_flags.hpp"
#include "support/inputs/trials.hpp"
#include "support/tree.hpp"

namespace rift::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// A command line that was run in a folder of its own.
struct Run {
  TemporaryFolder folder;
  ProcessResult result;
};

/// The first word of a text, and what follows it.
std::pair<std::string, std::string> Cut(const std::string& text) {
  const size_t at = text.find(' ');
  if (at == text.npos) return {text, ""};
  return {text.substr(0, at), text.substr(at + 1)};
}

json JsonAt(const std::string& text, const std::string& pointer) {
  const json document = json::parse(text, nullptr, false);
  const json::json_pointer at(pointer);
  return document.is_object() && document.contains(at) ? document[at] : json();
}

std::string FileIn(const Run& run, const std::string& name) {
  return fs::is_regular_file(run.folder / name) ? ReadFile(run.folder / name) : "";
}

bool Holds(const std::string& text, const std::string& part) {
  return text.find(part) != text.npos;
}

/// An effect that one run shows by itself.
bool Shows(const Run& run, const std::string& effect) {
  const auto [kind, what] = Cut(effect);
  const auto [name, text] = Cut(what);
  if (kind == "out") return Holds(run.result.out, what);
  if (kind == "err") return Holds(run.result.err, what);
  if (kind == "no-err") return !Holds(run.result.err, what);
  if (kind == "file") return !FileIn(run, name).empty() && Holds(FileIn(run, name), text);
  if (kind == "no-file") return !fs::exists(run.folder / name);
  if (kind == "json") return JsonAt(run.result.out, name).dump() == text;
  throw std::runtime_error("no such effect: " + effect);
}

/// Whether the effect is that of the flag.
bool IsEffect(const Run& with, const Run* without, const std::string& effect) {
  const auto [kind, what] = Cut(effect);
  const auto [name, text] = Cut(what);
  if (kind == "exit") return with.result.exit_code != without->result.exit_code;
  if (kind == "changes" || kind == "file-changes") {
    const auto value = [&, is_file = kind == "file-changes", &name = name, &text = text,
                        &what = what](const Run& run) {
      return is_file ? JsonAt(FileIn(run, name), text) : JsonAt(run.result.out, what);
    };
    const json now = value(with), before = value(*without);
    return !now.is_null() && !before.is_null() && now != before;
  }
  if (kind == "differs") {
    const std::string now = FileIn(with, what), before = FileIn(*without, what);
    return !now.empty() && !before.empty() && now != before;
  }
  return Shows(with, effect) && (without == nullptr || !Shows(*without, effect));
}

/// Without the ends of lines within a string that goes on, and those before a test's name.
std::string Joined(const std::string& source) {
  std::string joined;
  for (size_t i = 0; i < source.size(); ++i) {
    joined += source[i];
    const bool is_name = joined.ends_with("TEST_CASE(");
    if (source[i] != '"' && !is_name) continue;
    const size_t next = source.find_first_not_of(" \n", i + 1);
    const bool is_broken = next != source.npos && source[next] == '"' && next > i + 1;
    if (!is_broken) continue;
    if (!is_name) joined.pop_back();
    i = is_name ? next - 1 : next;
  }
  return joined;
}

/// The text of every file of tests.
const std::vector<std::string>& TestSources() {
  static const std::vector<std::string> texts = [] {
    std::vector<std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(SourceDir() + "/tests")) {
      if (entry.path().extension() == ".cpp") all.push_back(Joined(ReadFile(entry.path())));
    }
    return all;
  }();
  return texts;
}

/// Whether there is a test case of this name in a file that uses the flag.
bool IsTestOf(const std::string& name, const std::string& flag) {
  const auto& texts = TestSources();
  return std::any_of(texts.begin(), texts.end(), [&](const std::string& text) {
    const bool is_used = Holds(text, "\"" + flag + "\"") || Holds(text, flag + " ");
    return is_used && Holds(text, "TEST_CASE(\"" + name + "\"");
  });
}

class Runs {
 public:
  Runs(std::string command, const std::function<void(const TemporaryFolder&)>& prepare)
      : command_(std::move(command)) {
    prepare(prepared_);
  }

  /// The same words are run once, in whatever order.
  std::shared_ptr<Run> Of(const std::string& words) {
    std::istringstream text(words);
    const std::multiset<std::string> key{std::istream_iterator<std::string>(text), {}};
    std::shared_ptr<Run>& run = runs_[key];
    if (run) return run;
    run = std::make_shared<Run>();
    fs::copy(prepared_.Path(), run->folder.Path(),
             fs::copy_options::recursive | fs::copy_options::copy_symlinks);
    std::vector<std::string> all = SplitWords(words, run->folder);
    if (!command_.empty()) all.insert(all.begin(), command_);
    run->result = RunRift(all);
    return run;
  }

 private:
  std::string command_;
  TemporaryFolder prepared_;
  std::map<std::multiset<std::string>, std::shared_ptr<Run>> runs_;
};

}  // namespace

std::vector<std::string> SplitWords(const std::string& words, const TemporaryFolder& folder) {
  std::istringstream text(words);
  std::vector<std::string> split;
  for (std::string word; text >> word;) {
    for (const auto& [sign, meant] : {std::pair{'@', folder / ""}, {'%', SourceDir() + "/"}}) {
      if (const size_t at = word.find(sign); at != word.npos) word.replace(at, 1, meant);
    }
    std::replace(word.begin(), word.end(), '~', ' ');
    split.push_back(word);
  }
  return split;
}

void CheckFlags(const std::string& command,
                const std::function<void(const TemporaryFolder&)>& prepare,
                const std::vector<FlagRow>& rows) {
  std::set<std::string> in_table;
  for (const FlagRow& row : rows) in_table.insert(row.flag);
  CHECK(in_table == FlagsOf(command));
  Runs runs(command, prepare);
  for (const FlagRow& row : rows) {
    const auto [kind, what] = Cut(row.effect);
    if (kind == "test") {
      INFO(row.flag << " is left to the test \"" << what << "\", which must use it");
      CHECK(IsTestOf(what, row.flag));
      continue;
    }
    const bool has_base = row.base != "-";
    const std::string flagged = (has_base ? row.base + " " : "") + row.flag + " " + row.words;
    const std::shared_ptr<Run> without = has_base ? runs.Of(row.base) : nullptr;
    const std::shared_ptr<Run> with = runs.Of(flagged);
    INFO("rift " << command << " " << flagged << "\n"
                 << row.effect << "\n--- with\n"
                 << with->result.out.substr(0, 2000) << with->result.err << "--- without\n"
                 << (without ? without->result.out.substr(0, 2000) + without->result.err : ""));
    CHECK(with->result.exit_code == row.exit_code);
    CHECK(IsEffect(*with, without.get(), row.effect));
  }
}

}  // namespace rift::test
