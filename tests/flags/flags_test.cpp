#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "rift/flags/flags.hpp"
#include "rift/flags/manual.hpp"
#include "rift/flags/usage.hpp"
#include "rift/yaml/flag_name.hpp"

namespace rift::flags {
namespace {

using Catch::Matchers::Contains;

/// The error line; empty when the words were taken.
std::string ErrorOf(CLI::App& app, std::vector<std::string> words) {
  std::reverse(words.begin(), words.end());
  try {
    app.parse(words);
    return "";
  } catch (const CLI::ParseError& error) {
    return UsageError(app, error);
  }
}

enum class Kind { kOne, kTwo };
constexpr std::array<std::string_view, 2> EnumNames(Kind) { return {"one", "two"}; }

struct Options {
  double length_m = 0.5;
  int count = 3;
  bool is_loud = false;
  Kind kind = Kind::kTwo;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("length_m", self.length_m, -1.5, 2.0, "how far");
    field("count", self.count, 1, 9, "how many");
    field("is_loud", self.is_loud, "says more");
    field("kind", self.kind, "which");
  }
};

/// rift with two subcommands, and what they were given.
struct Program {
  CLI::App app{"measures gaps", "rift"};
  Options options;
  std::vector<std::string> files, pair;
  std::string out, pattern;
  int seed = 0;
  bool view = false;

  Program() {
    CLI::App* drive = app.add_subcommand("drive", "drives it");
    AddFlags(*drive, options);
    drive->add_option("FILE", files, "an experiment");
    drive->add_option("-o,--out", out, "a folder: [x]");
    drive->add_option("--images", pattern, "a pattern");
    drive->add_option("--seed", seed, "of the noise")->capture_default_str();
    drive->add_option("--compare", pair, "two folders")->expected(2);
    drive->add_flag("--view", view, "a window");
    drive->footer("Examples:\n  rift drive a-b.yaml");
    app.add_subcommand("sweep", "sweeps it");
    app.require_subcommand(1);
    RefuseEmptyValues(*drive, {{"--compare"}, {"--images"}});
  }
  std::string Parse(std::vector<std::string> words) { return ErrorOf(app, std::move(words)); }
};

std::string Said(const std::vector<std::string>& words) { return Program().Parse(words); }

TEST_CASE("Flags of options have their values, ranges and defaults") {
  Program program;
  CHECK(program.Parse({"drive", "--length=-1.5", "--count", "9", "--is-loud", "--kind", "one"})
            .empty());
  CHECK(program.options.length_m == -1.5);
  CHECK(program.options.count == 9);
  CHECK(program.options.is_loud);
  CHECK(program.options.kind == Kind::kOne);
  CHECK(Said({"drive", "--length", "2"}).empty());
  CHECK_THAT(Said({"drive", "--length", "2.01"}), Contains("'2.01' must be a number in [-1.5, 2]"));
  CHECK_THAT(Said({"drive", "--length=-1.51"}), Contains("must be a number in [-1.5, 2]"));
  CHECK_THAT(Said({"drive", "--length", "nan"}), Contains("'nan' must be a number in [-1.5, 2]"));
  for (const char* text : {"0x1", "1e-400", "1e999", "1,5", "0.5m", "+", "0x1p-1", "1e"}) {
    CHECK_THAT(Said({"drive", "--length", text}), Contains("must be a number in [-1.5, 2]"));
  }
  for (const char* text : {"+1.5", "15e-1", ".5", "1.", "1e0", "0"}) {
    INFO(text);
    CHECK(Said({"drive", "--length", text}).empty());
  }
  CHECK_THAT(Said({"drive", "--count", "0x4"}), Contains("'0x4' must be a whole number in [1, 9]"));
  CHECK_THAT(Said({"drive", "--count", "0"}), Contains("'0' must be a whole number in [1, 9]"));
  CHECK_THAT(Said({"drive", "--count", "10"}), Contains("must be a whole number in [1, 9]"));
  CHECK_THAT(Said({"drive", "--count", "2.5"}), Contains("must be a whole number in [1, 9]"));
  CHECK_FALSE(Said({"drive", "--kind", "three"}).empty());
  const std::string help = program.app.get_subcommand("drive")->help();
  CHECK_THAT(help, Contains("one|two") && Contains("=two") && Contains("]=0.5"));
}

TEST_CASE("What is wrong with a value is told with what the flag takes") {
  const std::string help = "; rift drive --help lists what it takes";
  CHECK(Said({"drive", "--seed", "few"}) == "--seed: 'few' must be a whole number");
  CHECK(Said({"drive", "--seed"}) == "--seed needs its value, a whole number" + help);
  CHECK(Said({"drive", "--out"}) == "--out needs its value, a value" + help);
  CHECK(Said({"drive", "--length"}) == "--length needs its value, m" + help);
  CHECK(Said({"drive", "--seed", "1", "--seed", "2"}) ==
        "--seed is given 2 times: give it once" + help);
  CHECK(Said({"drive", "--compare", "a"}) ==
        "--compare takes 2 values, a value, and 1 is given" + help);
  CHECK(Said({"drive", "--compare", "a", "b", "--compare", "c", "d"}) ==
        "--compare takes 2 values, a value, and 4 are given" + help);
  CHECK(Said({"drive", "--view=yes"}) == "--view takes no value: leave out what follows =" + help);
}

TEST_CASE("An empty value and a tilde that the shell left are refused, but for those who may") {
  CHECK_THAT(Said({"drive", "--out", ""}), Contains("its value is empty"));
  CHECK_THAT(Said({"drive", "--out", "~"}),
             Contains("'~': the shell replaces ~") && Contains("write $HOME"));
  CHECK_THAT(Said({"drive", "--out", "~/run"}), Contains("write $HOME/run"));
  CHECK(Said({"drive", "--out", "a~b"}).empty());
  CHECK(Said({"drive", "--out", "~other"}).empty());
  CHECK(Said({"drive", "--images", "~/run/*.jpg"}).empty());
  CHECK_THAT(Said({"drive", "--images", ""}), Contains("its value is empty"));
  CHECK(Said({"drive", "--compare", "", "~"}).empty());
}

TEST_CASE("A flag or an argument that nobody knows is told with the nearest") {
  CHECK(Said({"drive", "--lengt", "1"}) ==
        "rift drive has no flag --lengt; did you mean --length?");
  CHECK(Said({"drive", "--count=1", "--sead=1"}) ==
        "rift drive has no flag --sead; did you mean --seed?");
  CHECK(Said({"drive", "--xyzzyplugh"}) ==
        "rift drive has no flag --xyzzyplugh; rift drive --help lists what it takes");
  CHECK(Said({"sweep", "a"}) ==
        "'a' is one argument too many for rift sweep; rift sweep --help lists what it takes");
  CHECK_THAT(Said({"sweep", "a", "b", "c"}),
             Contains("'a' and 2 more are too many arguments for rift sweep") &&
                 Contains("needs its quotes"));
  CHECK_THAT(Said({}), Contains("; rift --help lists what it takes"));
}

TEST_CASE("A subcommand that is none is told with the nearest, or with all") {
  const std::vector<std::string> names{"drive", "sweep"};
  CHECK_NOTHROW(RequireSubcommand("sweep", names));
  CHECK_THROWS_WITH(RequireSubcommand("swep", names),
                    "'swep' is no subcommand; did you mean 'sweep'?");
  CHECK_THROWS_WITH(RequireSubcommand("hepl", names), Contains("did you mean 'help'?"));
  CHECK_THROWS_WITH(RequireSubcommand("zzzzzzzz", names),
                    "'zzzzzzzz' is no subcommand; there are drive, sweep, help");
}

TEST_CASE("A manual is made of the flags, their types, defaults and notes") {
  const Program program;
  const std::string page = Manual({"help", "--man", "drive"}, program.app);
  CHECK_THAT(page, Contains(".TH rift-drive 1 ") && Contains("rift\\-drive \\- drives it"));
  CHECK_THAT(page, Contains("\\fBrift drive\\fR [OPTIONS] [FILE]\n"));
  CHECK_THAT(page, Contains("\\fB\\-\\-length m\\fR\nhow far [0.5]\n"));
  CHECK_THAT(page, Contains("\\fB\\-\\-view\\fR\na window\n"));
  CHECK_THAT(page, Contains("\\fB\\-o, \\-\\-out TEXT\\fR\n"));
  CHECK_THAT(page, Contains(".SH NOTES\n.nf\nExamples:\n  rift drive a\\-b.yaml\n.fi\n"));
  CHECK(page.find(".SH COMMANDS") == std::string::npos);
  const std::string whole = Manual({"help", "--man"}, program.app);
  CHECK_THAT(whole, Contains(".TH rift 1 ") && Contains("COMMAND [OPTIONS]") &&
                        Contains("\\fBrift\\-sweep\\fR(1)\nsweeps it\n"));
}

TEST_CASE("Completions hold the commands, their flags and the words of a flag") {
  const Program program;
  const std::string bash = Manual({"help", "--bash"}, program.app);
  CHECK_THAT(bash, Contains("compgen -W 'drive sweep help --help --version'"));
  CHECK_THAT(bash, Contains("'help help') words='drive sweep' ;;"));
  CHECK_THAT(bash, Contains("'drive --kind') words='one two' ;;"));
  CHECK_THAT(bash,
             Contains("      drive) words='") && Contains(" --length ") && Contains(" -o --out "));
  CHECK(bash.find("'drive --length'") == std::string::npos);
  const std::string zsh = Manual({"help", "--zsh"}, program.app);
  CHECK_THAT(zsh, Contains("'drive:drives it'"));
  CHECK_THAT(zsh, Contains("'--kind[which]:one|two:(one two)'"));
  CHECK_THAT(zsh, Contains("'--view[a window]'"));
  CHECK_THAT(zsh, Contains("'--out[a folder\\: \\[x\\]]:TEXT:_files'"));
}

TEST_CASE("Words that ask for no manual give none") {
  const Program program;
  for (const std::vector<std::string>& words : {std::vector<std::string>{"help"},
                                                {"help", "drive"},
                                                {"drive", "--man"},
                                                {"help", "--man", "drive", "more"}}) {
    CHECK(Manual(words, program.app).empty());
  }
}

TEST_CASE("A flag is its key with dashes, without the unit that its help names") {
  const auto named = [](const char* key) {
    const yaml::FlagName name(key);
    return name.flag + " " + name.unit;
  };
  CHECK(named("window_size_m") == "--window-size m");
  CHECK(named("period_s") == "--period s");
  CHECK(named("turn_rad") == "--turn rad");
  CHECK(named("cap_angle_deg") == "--cap-angle deg");
  CHECK(named("rate_hz") == "--rate hz");
  CHECK(named("speed_mps") == "--speed-mps ");
  CHECK(named("samples") == "--samples ");
}

/// Values that a file has no need of, and types of which the help has names of its own.
struct Extra {
  std::optional<double> limit_m;
  std::optional<int> rounds;
  double square_mm = 25.0;
  std::string word = "none";
  std::vector<std::string> many;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("limit_m", self.limit_m, 0.5, 2.0, "METRES", "how far at most");
    field("rounds", self.rounds, 2, 7, "N", "how often");
    field("square_mm", self.square_mm, 1.0, 50.0, "mm", "of a board");
    field("word", self.word, "WORD", "what is said");
    field("many", self.many, "FILE", "what is read");
  }
};

/// A subcommand with them, and what was wrong; nothing where nothing was.
struct ExtraProgram {
  CLI::App app{"measures gaps", "rift"};
  Extra extra;
  unsigned repeats = 1;
  double gain = 1.0;
  std::vector<std::string> some;

  ExtraProgram() {
    CLI::App* run = app.add_subcommand("run", "runs it");
    AddFlags(*run, extra);
    run->add_option("--repeats", repeats, ".5 \\ 'a'");
    run->add_option("--gain", gain, "'quoted'\n.dot");
    run->add_option("--some", some, "a few")->expected(2, 3)->type_name("FILE.csv|DIR");
    app.require_subcommand(1);
  }
  std::string Parse(std::vector<std::string> words) {
    words.insert(words.begin(), "run");
    return ErrorOf(app, std::move(words));
  }
};

TEST_CASE("A value that may be left out has a range too, and is not there unless it is given") {
  const auto said = [](const std::vector<std::string>& words) {
    return ExtraProgram().Parse(words);
  };
  ExtraProgram none, all;
  CHECK(none.Parse({}).empty());
  CHECK_FALSE(none.extra.limit_m);
  CHECK_FALSE(none.extra.rounds);
  CHECK(none.extra.square_mm == 25.0);
  CHECK(none.extra.word == "none");
  CHECK(all.Parse({"--limit", "0.5", "--rounds", "7", "--square-mm", "50", "--word", "a b",
                   "--many", "x", "y"})
            .empty());
  CHECK(all.extra.limit_m == 0.5);
  CHECK(all.extra.rounds == 7);
  CHECK(all.extra.square_mm == 50.0);
  CHECK(all.extra.word == "a b");
  CHECK(all.extra.many == std::vector<std::string>{"x", "y"});
  CHECK(said({"--limit", "2", "--rounds", "2"}).empty());
  CHECK(said({"--limit", "0.49"}) == "--limit: '0.49' must be a number in [0.5, 2]");
  CHECK(said({"--limit", "2.01"}) == "--limit: '2.01' must be a number in [0.5, 2]");
  CHECK(said({"--rounds", "1"}) == "--rounds: '1' must be a whole number in [2, 7]");
  CHECK(said({"--rounds", "8"}) == "--rounds: '8' must be a whole number in [2, 7]");
  CHECK(said({"--square-mm", "51"}) == "--square-mm: '51' must be a number in [1, 50]");
  const std::string help = all.app.get_subcommand("run")->help();
  CHECK_THAT(help, Contains("--limit METRES") && Contains("--rounds N") && Contains("WORD"));
}

TEST_CASE("What a value must be is told by the type of its flag, and how many there may be") {
  const auto said = [](const std::vector<std::string>& words) {
    return ExtraProgram().Parse(words);
  };
  const std::string help = "; rift run --help lists what it takes";
  CHECK(said({"--repeats"}) == "--repeats needs its value, a whole number" + help);
  CHECK(said({"--gain"}) == "--gain needs its value, a number" + help);
  CHECK(said({"--word"}) == "--word needs its value, WORD" + help);
  CHECK(said({"--repeats", "x"}) == "--repeats: 'x' must be a whole number");
  CHECK(said({"--gain", "x"}) == "--gain: 'x' must be a number");
  CHECK(said({"--some", "a"}) == "--some takes 2 values, FILE.csv|DIR, and 1 is given" + help);
  CHECK(said({"--some", "a", "b", "--some", "c", "d"}) ==
        "--some takes 3 values, FILE.csv|DIR, and 4 are given" + help);
  CHECK(said({"--some", "a", "b"}).empty());
}

TEST_CASE("Of wrong uses the first that is given is told, and excluded flags are") {
  CHECK_NOTHROW(Refuse({}));
  CHECK_NOTHROW(Refuse({{false, "a"}, {false, "b"}}));
  CHECK_THROWS_WITH(Refuse({{false, "a"}, {true, "b"}, {true, "c"}}), "b");
  CHECK_THROWS_AS(Refuse({{true, "a"}}), std::invalid_argument);
  const auto said = [](const std::vector<std::string>& words) {
    ExtraProgram program;
    Exclude(*program.app.get_subcommand("run"), "--word", {"--gain", "--repeats"});
    return program.Parse(words);
  };
  CHECK(said({"--gain", "2", "--repeats", "2"}).empty());
  CHECK(said({"--word", "a"}).empty());
  for (const char* other : {"--gain", "--repeats"}) {
    CHECK_THAT(said({"--word", "a", other, "2"}), Contains("--word") && Contains(other));
  }
}

TEST_CASE("A page takes backslashes and lines that begin with a dot or a quote as text") {
  const ExtraProgram program;
  const std::string page = Manual({"help", "--man", "run"}, program.app);
  CHECK_THAT(page, Contains("\\fB\\-\\-repeats UINT\\fR\n\\&.5 \\e 'a'\n"));
  CHECK_THAT(page, Contains("\\fB\\-\\-gain FLOAT\\fR\n\\&'quoted'\n\\&.dot\n"));
  CHECK_THAT(page, Contains("\\fB\\-\\-some FILE.csv|DIR"));
  const std::string zsh = Manual({"help", "--zsh"}, program.app);
  CHECK_THAT(zsh, Contains(":FILE.csv|DIR:_files'"));
  const std::string bash = Manual({"help", "--bash"}, program.app);
  CHECK(bash.find("'run --some'") == std::string::npos);
}

}  // namespace
}  // namespace rift::flags
