// A journal's file: behind a first byte D damage to a sound one, else the file itself.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "fuzz.hpp"
#include "rift/sweep/run/journal.hpp"
#include "rift/sweep/run/journal_summary.hpp"

namespace rift {
namespace {

namespace fs = std::filesystem;

const sweep::Facts kFacts{{"gap.threshold_m", "0.06"}, {"seed", "1"}};
const std::string kRow = "the findings of a trial";

fs::path File() {
  static const fs::path file =
      fs::temp_directory_path() / ("rift_fuzz_" + std::to_string(::getpid()) + ".sqlite");
  return file;
}

std::string SoundFile() {
  sweep::Journal::Remove(File());
  sweep::Journal journal(File(), kFacts);
  for (const char* key : {"x=1", "x=2"}) journal.Add(key, {"ok", 0.01, false, kRow});
  journal.SetNote("state", "done");
  journal.Close();
  std::ifstream file(File(), std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Calls; bad input and a damaged file are told in one line.
template <class Use>
void Try(const Use& use) {
  try {
    use();
  } catch (const std::invalid_argument& error) {
    fuzz::RequireOneLine(error.what());
  } catch (const std::runtime_error& error) {
    fuzz::RequireOneLine(error.what());
  }
}

}  // namespace
}  // namespace rift

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rift;
  static const std::string sound = SoundFile();
  const std::string_view text = fuzz::TextOf(data, size);
  const bool is_damage = text.starts_with('D');
  sweep::Journal::Remove(File());
  std::ofstream(File(), std::ios::binary)
      << (is_damage ? fuzz::Overwritten(sound, text.substr(1)) : std::string(text));
  Try([] { sweep::ReadJournal(File()); });
  Try([&] {
    sweep::Journal journal(File(), kFacts);
    for (const char* key : {"x=1", "x=2"}) {
      const auto row = journal.Find(key);
      fuzz::Require(!row || (is_damage && row == kRow),
                    "a row that is believed is the one written");
    }
    journal.Add("x=3", {"ok", 0.01, false, kRow});
    journal.Close();
  });
  sweep::Journal::Remove(File());
  return 0;
}
