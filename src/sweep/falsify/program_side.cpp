#include "program_side.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "program_answer.hpp"
#include "rift/experiment/path_template.hpp"
#include "rift/experiment/program_parameters.hpp"
#include "rift/files/process_end.hpp"
#include "rift/statistics/hash.hpp"
#include "rift/sweep/falsify/program_files.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/sweep/run/machine_trouble.hpp"
#include "simulated_recording.hpp"

namespace rift::sweep {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr const char* kLogName = "trajectory.csv";
constexpr const char* kThetaName = "theta.json";
constexpr char kFirstOfTrial = '{';  ///< of the JSON that a persistent program reads

std::string Joined(const std::string& text, const std::string& words) {
  return words.empty() ? text : text + ": " + words;
}

/// What a program is told of its trial.
ordered_json TrialJson(const experiment::Experiment& experiment,
                       const std::vector<experiment::Parameter>& parameters,
                       const TrialRequest& request, const std::string& folder) {
  ordered_json theta = ordered_json::object();
  for (size_t i = 0; i < request.theta.size(); ++i) {
    theta[parameters[i].key] = ValueJson(request.theta[i]);
  }
  return {{"theta", theta},
          {"seed", request.seed.value_or(experiment.seed)},
          {"trial", request.trial},
          {"out", (fs::path(folder) / kLogName).string()}};
}

std::string HostName() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "this machine";
}

/// A code that says two things of a run says none.
void RefuseEqualCodes(const ProgramOptions& options) {
  std::map<int, std::string_view> key_of;
  experiment::ExitCodes::Fields(
      options.exit_codes, [&](std::string_view key, int code, int, int, std::string_view) {
        const auto [other, is_new] = key_of.emplace(code, key);
        if (is_new) return;
        throw std::invalid_argument(
            fmt::format("{}.exit_codes: {} and {} are both {}: each needs a code of its own",
                        options.key, other->second, key, code));
      });
}

/// What arguments may name of a trial beside its parameters; seed and trial are none anywhere.
void RefuseNamesOfOurs(const std::vector<experiment::Parameter>& parameters) {
  for (const experiment::Parameter& parameter : parameters) {
    for (const std::string_view ours : {"out", "folder", "theta"}) {
      if (parameter.Name() != ours) continue;
      throw std::invalid_argument(fmt::format(
          "{}{}: {{{}}} is what rift tells a program: name the parameter otherwise",
          parameter.origin.empty() ? "" : parameter.origin + ": ", parameter.key, ours));
    }
  }
}

/// An argument with the values of the trial in the place of their names in braces.
std::string FilledIn(const std::string& word, const experiment::Experiment& experiment,
                     std::vector<experiment::Parameter> parameters, const TrialRequest& request,
                     const std::string& folder) {
  experiment::Theta theta = request.theta;
  const auto add = [&](const char* name, experiment::ParameterValue value) {
    parameters.push_back({.key = name});
    theta.push_back(std::move(value));
  };
  const std::uint64_t seed = request.seed.value_or(experiment.seed);
  add("seed", {fmt::format("{}", seed), static_cast<double>(seed)});
  add("folder", {folder, std::nullopt});
  add("out", {(fs::path(folder) / kLogName).string(), std::nullopt});
  add("theta", {(fs::path(folder) / kThetaName).string(), std::nullopt});
  return experiment::FillTemplate(word, parameters, theta, request.trial);
}

/// rift mends a log that a killed writer left, and sorts rows by time; of a program that says it is
/// done either is a fault.
void RefuseMended(const trajectory::Log& log) {
  for (const std::string& note : log.notes) {
    if (note.find("cut short") != note.npos) {
      throw std::invalid_argument("its trajectory: its last row is cut short");
    }
    if (note.starts_with("time runs backwards")) {
      throw std::invalid_argument(
          "its trajectory: time runs backwards in it: write rows in the order of their time");
    }
  }
}

/// What fails where the disk is full is no finding of the trial. Asked before its folder is
/// removed.
void RefuseFullDisk(const std::string& folder, const Recording& recording) {
  constexpr std::uintmax_t kPage_bytes = 4096;
  const TrialStatus status = recording.status;
  if (status != TrialStatus::kFault && status != TrialStatus::kCrashed &&
      status != TrialStatus::kUnreadable) {
    return;
  }
  std::error_code error;
  const bool has_room = fs::space(folder, error).available >= kPage_bytes || error;
  if (has_room && recording.reason.find("No space left on device") == std::string::npos) return;
  throw MachineTrouble(fmt::format(
      "the disk of {} is full, and a program failed there ({}): make room, or set TMPDIR to a "
      "folder on another disk, and run the same command again",
      fs::path(folder).parent_path().string(), recording.reason));
}

bool IsCrash(TrialStatus status) {
  return status == TrialStatus::kCrashed || status == TrialStatus::kOutOfMemory;
}

}  // namespace

ProgramSide::ProgramSide(const experiment::Experiment& experiment, ProgramOptions options,
                         const Inputs& inputs)
    : experiment_(experiment),
      parameters_(experiment::ProgramParameters(experiment)),
      options_(std::move(options)),
      inputs_(inputs) {
  if (options_.run.words.empty()) {
    throw std::invalid_argument(
        fmt::format("{}.run is missing: name the program, such as {}.run: [python3, sim.py, --out, "
                    "\"{{out}}\"]",
                    options_.key, options_.key));
  }
  RefuseEqualCodes(options_);
  RefuseNamesOfOurs(parameters_);
  const TrialRequest nominal = NominalRequest(experiment);
  for (const std::string& word : options_.run.words) {
    try {
      FilledIn(word, experiment, parameters_, nominal, "/");
      const std::vector<std::string> names = experiment::TemplateNames(word);
      const bool names_folder_only = std::all_of(names.begin(), names.end(),
                                                 [](const auto& name) { return name == "folder"; });
      if (options_.persistent && !names_folder_only) {
        throw std::invalid_argument(
            fmt::format("'{}': a persistent program is told of its trials in lines of JSON", word));
      }
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("{}.run: {}", options_.key, error.what()));
    }
    std::error_code none;
    if (!fs::path(word).is_absolute() || !fs::is_regular_file(word, none)) continue;
    const std::optional<std::string> bytes = inputs.read(word);
    if (bytes) hashes_ += fmt::format("{}  {}\n", statistics::Hash128Text(*bytes), word);
  }
  try {
    RequireScript(options_.run.words);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}.run: {}", options_.key, error.what()));
  }
}

ProgramSide::~ProgramSide() {
  // A copy of the process that started it, which alone may end it.
  if (program_ && program_->Owner() != ::getpid()) static_cast<void>(program_.release());
}

ProgramStart ProgramSide::StartOf(const TrialRequest& request, const std::string& folder) const {
  ProgramStart start{.memory_mb = experiment_.run.memory_mb, .talks = options_.persistent};
  for (const std::string& word : options_.run.words) {
    start.arguments.push_back(FilledIn(word, experiment_, parameters_, request, folder));
  }
  if (!options_.persistent) {
    const ordered_json trial = TrialJson(experiment_, parameters_, request, folder);
    start.environment["RIFT_TRIAL"] = trial.dump();
    start.files[kThetaName] = trial.dump(1) + "\n";
  }
  return start;
}

Recording ProgramSide::Run(const TrialRequest& request) {
  Recording recording;
  int runs = 0;
  do {
    recording = RunOnce(request);
    ++runs;
  } while (IsCrash(recording.status) && runs <= experiment_.run.retries);
  if (IsCrash(recording.status) && runs > 1) {
    recording.reason += runs == 2 ? ", twice" : fmt::format(", {} times", runs);
  }
  return recording;
}

Recording ProgramSide::RunOnce(const TrialRequest& request) {
  Recording recording = options_.persistent ? RunPersistent(request) : RunSpawned(request);
  recording.source = fmt::format("program with seed {}", request.seed.value_or(experiment_.seed));
  return recording;
}

Recording ProgramSide::RunSpawned(const TrialRequest& request) {
  const std::string folder = ExternalProgram::MakeFolder();
  const ProgramStart start = StartOf(request, folder);
  ExternalProgram program(start, folder);
  Recording recording;
  const ExternalProgram::Exit exit = program.Wait();  // before its last words are read
  TakeExit(exit, program.LastWords(), recording);
  ReadLogFile(folder, recording);
  RefuseFullDisk(folder, recording);
  return recording;
}

ExternalProgram& ProgramSide::ProgramFor(const TrialRequest& request) {
  if (program_ && program_->Owner() != ::getpid()) static_cast<void>(program_.release());
  // A line that came after the answer to the trial before would be taken for that to this one.
  if (program_ && !program_->UnreadAtNextLine(kFirstOfTrial, -1).empty()) program_.reset();
  if (!program_) {
    const std::string folder = ExternalProgram::MakeFolder();
    program_ = std::make_unique<ExternalProgram>(StartOf(request, folder), folder);
    return *program_;  // which may already have said that it cannot be run
  }
  program_->ForgetWords();
  std::error_code none;
  fs::remove(fs::path(program_->Folder()) / kLogName, none);
  return *program_;
}

/// A program that breaks the protocol is ended: nobody knows what it would answer next.
Recording ProgramSide::RunPersistent(const TrialRequest& request) {
  ExternalProgram& program = ProgramFor(request);
  ordered_json trial = TrialJson(experiment_, parameters_, request, program.Folder());
  const std::string id = TrialId(trial);
  trial["id"] = id;
  std::optional<std::string> line;
  if (program.SendLine(trial.dump())) line = program.ReceiveLine();
  if (!line) return EndedInTrial();
  const ordered_json answer = ordered_json::parse(*line, nullptr, false);
  Recording recording;
  constexpr int kMost_ms = 200;  // what comes later is of no trial
  recording.reason = BreachIn(answer, *line, id, program.UnreadAtNextLine(kFirstOfTrial, kMost_ms));
  if (!recording.reason.empty()) {
    recording.status = TrialStatus::kFault;
    program_.reset();
    return recording;
  }
  TakeAnswer(answer, recording);
  RefuseFullDisk(program.Folder(), recording);
  return recording;
}

Recording ProgramSide::EndedInTrial() {
  const std::unique_ptr<ExternalProgram> ended = std::move(program_);
  Recording recording;
  const ExternalProgram::Exit exit = ended->Wait();
  TakeExit(exit, ended->LastWords(), recording);
  recording.reason = Joined("ended in the middle of a trial", recording.reason);
  if (recording.status != TrialStatus::kOutOfMemory) recording.status = TrialStatus::kCrashed;
  RefuseFullDisk(ended->Folder(), recording);
  return recording;
}

void ProgramSide::TakeAnswer(const ordered_json& answer, Recording& recording) const {
  recording.status = StatusIn(answer);
  if (answer.contains("reason") && answer["reason"].is_string()) {
    recording.reason = ShortWords(answer["reason"].get<std::string>());
  }
  if (recording.status != TrialStatus::kOk && recording.reason.empty()) {
    recording.reason = Joined("the program says so", program_->LastWords());
  }
  if (answer.contains("log") && answer["log"].is_string()) {
    ReadLog(answer["log"].get<std::string>(), recording);
  } else {
    ReadLogFile(program_->Folder(), recording);
  }
}

void ProgramSide::TakeExit(const ExternalProgram::Exit& exit, const std::string& words,
                           Recording& recording) const {
  if (exit.signal == 0 && exit.code == 0) return;
  if (ExternalProgram::WasNeverStarted(exit, words)) {
    throw MachineTrouble(
        fmt::format("{}.run: {}, on {}: it is no result of a trial; install it there, or mend the "
                    "name or PATH, and run the same command again",
                    options_.key, words, HostName()));
  }
  const experiment::ExitCodes& codes = options_.exit_codes;
  recording.status = exit.signal != 0                ? TrialStatus::kCrashed
                     : exit.code == codes.timed_out  ? TrialStatus::kTimedOut
                     : exit.code == codes.fell       ? TrialStatus::kFell
                     : exit.code == codes.left_arena ? TrialStatus::kLeftArena
                     : exit.code == codes.lost       ? TrialStatus::kLost
                                                     : TrialStatus::kFault;
  recording.reason = files::ProcessEndText(exit.code, exit.signal, words);
  const auto has = [&](const char* text) { return words.find(text) != words.npos; };
  const bool wants_memory = has("bad_alloc") || has("MemoryError");
  const bool wants_disk = exit.signal == SIGXFSZ || has("File too large");
  if (!wants_memory && !wants_disk) return;
  recording.status = TrialStatus::kOutOfMemory;
  recording.reason =
      Joined(fmt::format("wanted {} more than {} MB (run.memory_mb)",
                         wants_memory ? "memory of" : "a file of", experiment_.run.memory_mb),
             words);
}

void ProgramSide::ReadLogFile(const std::string& folder, Recording& recording) const {
  const std::string path = (fs::path(folder) / kLogName).string();
  std::optional<std::string> text;
  try {
    text = inputs_.read(path);
  } catch (const std::invalid_argument& cannot_read) {
    if (recording.status != TrialStatus::kOk) return;
    recording.status = TrialStatus::kUnreadable;
    recording.reason = cannot_read.what();
    // The name of the folder is drawn at random, and the same trial gives the same row.
    if (const size_t at = recording.reason.find(path); at != std::string::npos) {
      recording.reason.replace(at, path.size(), "its trajectory");
    }
    return;
  }
  if (text) {
    ReadLog(*text, recording);
  } else if (recording.status == TrialStatus::kOk) {
    recording.status = TrialStatus::kFault;
    recording.reason = "ended well and wrote no trajectory to {out}";
  }
}

/// Of a run that did not arrive the log tells how far it came, if it can be read.
void ProgramSide::ReadLog(const std::string& text, Recording& recording) const {
  try {
    trajectory::Log log = ReadMovedLog(text, "its trajectory", options_.log);
    RefuseMended(log);
    recording.trajectory = std::move(log.trajectory);
    recording.doubts = std::move(log.doubts);
    if (recording.status != TrialStatus::kOk) {
      recording.left_m = DistanceLeft_m(recording.trajectory);
    }
  } catch (const std::invalid_argument& bad_log) {
    if (recording.status != TrialStatus::kOk) return;
    recording.status = TrialStatus::kUnreadable;
    recording.reason = bad_log.what();
  }
}

double ProgramSide::DistanceLeft_m(const trajectory::Trajectory& path) const {
  if (experiment_.waypoints.size() < 2 || path.poses.empty()) return gap::kNotComputed;
  return WayLeft_m(path, experiment_.waypoints, experiment_.control.reach_radius_m);
}

std::unique_ptr<ProgramSide> CandidateProgram(const experiment::Experiment& experiment,
                                              LogOptions log, const Inputs& inputs) {
  const experiment::CandidateOptions& side = experiment.candidate;
  if (side.kind != experiment::CandidateKind::kProgram) return nullptr;
  return std::make_unique<ProgramSide>(
      experiment,
      ProgramOptions{"candidate", side.run, side.persistent, side.exit_codes, std::move(log)},
      inputs);
}

std::unique_ptr<ProgramSide> ReferenceProgram(const experiment::Experiment& experiment,
                                              LogOptions log, const Inputs& inputs) {
  const experiment::ReferenceOptions& side = experiment.reference;
  if (side.kind != experiment::ReferenceKind::kProgram) return nullptr;
  return std::make_unique<ProgramSide>(
      experiment,
      ProgramOptions{"reference", side.run, side.persistent, side.exit_codes, std::move(log)},
      inputs);
}

}  // namespace rift::sweep
