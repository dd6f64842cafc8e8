#include "rift/sweep/run/slurm.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <string_view>

#include "rift/sweep/run/byte_codec.hpp"
#include "rift/sweep/run/external_program.hpp"
#include "worker.hpp"

namespace rift::sweep {
namespace {

/// What Slurm says when the same question may be answered later.
bool IsTemporary(const std::string& words) {
  constexpr std::array<std::string_view, 11> kTemporary{
      "temporarily",       "try again",          "timed out",
      "Unable to contact", "Connection refused", "missing socket error",
      "Zero Bytes",        "submit limit",       "job limit",
      "QOSMaxSubmit",      "AssocMaxSubmit"};
  return std::any_of(kTemporary.begin(), kTemporary.end(),
                     [&](std::string_view part) { return words.find(part) != words.npos; });
}

std::string EndOf(const ExternalProgram::Exit& exit) {
  return exit.signal != 0 ? fmt::format("was ended by signal {}", exit.signal)
                          : fmt::format("ended with exit code {}", exit.code);
}

/// How a command ended, and what it printed.
struct Ended {
  ExternalProgram::Exit exit;
  std::string out, words;
};

template <class Bytes, Is<Ended> T>
void Members(Bytes& bytes, T& ended) {
  bytes(ended.exit);
  bytes(ended.out);
  bytes(ended.words);
}

Ended RunToItsEnd(const std::vector<std::string>& arguments) {
  ExternalProgram program({.arguments = arguments, .talks = true}, ExternalProgram::MakeFolder());
  Ended ended;
  while (const std::optional<std::string> line = program.ReceiveLine()) ended.out += *line + '\n';
  ended.exit = program.Wait();
  ended.words = program.LastWords();
  return ended;
}

/// In a process of its own, with which the command is killed where it takes too long.
Ended Run(const std::vector<std::string>& arguments, const SlurmPatience& patience) {
  using Clock = std::chrono::steady_clock;
  using Seconds = std::chrono::duration<double>;
  constexpr int kTick_ms = 50;
  const auto work = [&arguments](const std::string&) {
    ByteWriter write;
    write(RunToItsEnd(arguments));
    return write.Take();
  };
  Worker worker(work, {});
  worker.Send("");
  Clock::time_point since = Clock::now();
  double limit_s = patience.limit_s;
  for (bool is_stopped = false; Seconds(Clock::now() - since).count() < limit_s;) {
    if (!is_stopped && !patience.go_on()) {
      is_stopped = true;
      since = Clock::now();
      limit_s = std::min(limit_s, SlurmPatience::kAtStop_s);
    }
    pollfd waiting{worker.Descriptor(), POLLIN, 0};
    ::poll(&waiting, 1, kTick_ms);
    const bool is_alive = worker.Receive();
    if (const std::optional<JobResult> result = worker.NextResult()) {
      if (result->end != JobEnd::kDone) throw std::runtime_error(result->bytes);
      Ended ended;
      ByteReader read(result->bytes);
      read(ended);
      return ended;
    }
    if (!is_alive) throw SlurmBusy(fmt::format("{}: {}", arguments[0], worker.Reap().reason));
  }
  throw SlurmBusy(fmt::format("{} did not answer within {:g} s", arguments[0], limit_s));
}

/// What a command of Slurm prints. Throws as the header says.
std::string Answer(const std::vector<std::string>& arguments, const SlurmPatience& patience) {
  const auto [exit, out, words] = Run(arguments, patience);
  if (exit.code == 0 && exit.signal == 0) return out;
  if (ExternalProgram::WasNeverStarted(exit, words)) {
    throw std::runtime_error(fmt::format(
        "{}: --engine slurm needs Slurm's commands in PATH; without them use --engine local",
        words));
  }
  const bool is_named = words.starts_with(arguments[0] + ":");
  const std::string text =
      fmt::format("{}{}{}", is_named ? "" : arguments[0] + ": ",
                  words.empty() ? EndOf(exit) + " without a word" : words,
                  words.find("configuration source") == words.npos
                      ? ""
                      : "; --engine slurm works where Slurm answers, as on its login node: use "
                        "--engine local here");
  // Who killed it did not mean the sweep.
  if (exit.signal != 0 || IsTemporary(words)) throw SlurmBusy(text);
  throw std::runtime_error(text);
}

/// A '%' begins a pattern in a name of --output.
std::string WithoutPatterns(const std::string& path) {
  std::string text;
  for (const char c : path) text += c == '%' ? std::string("%%") : std::string(1, c);
  return text;
}

}  // namespace

std::string IndexRanges(const std::vector<int>& indices) {
  std::string text;
  for (size_t i = 0; i < indices.size();) {
    size_t last = i;
    while (last + 1 < indices.size() && indices[last + 1] == indices[last] + 1) ++last;
    text += fmt::format("{}{}", text.empty() ? "" : ",", indices[i]);
    if (last > i) text += fmt::format("-{}", indices[last]);
    i = last + 1;
  }
  return text;
}

std::string SubmitArray(const SlurmArray& array, const SlurmOptions& options,
                        const SlurmPatience& patience) {
  // A job would inherit the limits under which ExternalProgram runs sbatch.
  std::vector<std::string> arguments{"sbatch",
                                     "--parsable",
                                     "--propagate=NONE",
                                     "--job-name=" + array.name,
                                     "--chdir=" + array.folder.string(),
                                     "--output=" + WithoutPatterns(array.logs.string()) + "/%a.log",
                                     "--open-mode=append",
                                     "--requeue",
                                     fmt::format("--cpus-per-task={}", options.cpus_per_task)};
  std::string tasks = "--array=" + IndexRanges(array.tasks);
  if (options.shards_at_once > 0) tasks += fmt::format("%{}", options.shards_at_once);
  arguments.push_back(tasks);
  if (!options.account.empty()) arguments.push_back("--account=" + options.account);
  if (!options.partition.empty()) arguments.push_back("--partition=" + options.partition);
  if (!options.time_limit.empty()) arguments.push_back("--time=" + options.time_limit);
  arguments.insert(arguments.end(), options.arguments.begin(), options.arguments.end());
  arguments.push_back(array.script.string());
  const std::string answer = Answer(arguments, patience);  // "123\n" or "123;cluster\n"
  std::string id = answer.substr(0, answer.find_first_not_of("0123456789"));
  if (id.empty()) throw std::runtime_error("sbatch told no job id, but: " + answer);
  return id;
}

std::map<int, SlurmTask> QueuedTasks(const std::string& name, const SlurmPatience& patience) {
  std::istringstream lines(
      Answer({"squeue", "--me", "--noheader", "--array", "--name=" + name, "--format=%i|%T|%r"},
             patience));
  std::map<int, SlurmTask> tasks;
  for (std::string line; std::getline(lines, line);) {
    const size_t task = line.find('_'), state = line.find('|'), reason = line.rfind('|');
    if (task == line.npos || state == line.npos || reason == state || task > state) continue;
    SlurmTask& found = tasks[std::atoi(line.c_str() + task + 1)];
    found = {line.substr(0, task), line.substr(state + 1, reason - state - 1),
             line.substr(reason + 1)};
    if (found.reason == "None") found.reason.clear();
  }
  return tasks;
}

void CancelArrays(const std::string& name, const SlurmPatience& patience) {
  std::map<int, SlurmTask> tasks = QueuedTasks(name, patience);
  std::vector<std::string> arguments{"scancel"};
  for (const auto& [index, task] : tasks) arguments.push_back(task.job);
  std::sort(arguments.begin() + 1, arguments.end());
  arguments.erase(std::unique(arguments.begin() + 1, arguments.end()), arguments.end());
  if (arguments.size() > 1) Answer(arguments, patience);
}

void CancelTask(const SlurmTask& task, int index, const SlurmPatience& patience) {
  Answer({"scancel", fmt::format("{}_{}", task.job, index)}, patience);
}

int MaxArraySize(const SlurmPatience& patience) {
  constexpr int kDefault = 1001;  // slurm.conf(5)
  std::istringstream lines;
  try {
    lines.str(Answer({"scontrol", "show", "config"}, patience));
  } catch (const SlurmBusy&) {
    return kDefault;
  }
  for (std::string line; std::getline(lines, line);) {
    const size_t equals = line.find('=');
    if (line.starts_with("MaxArraySize") && equals != line.npos) {
      return std::max(1, std::atoi(line.c_str() + equals + 1));
    }
  }
  return kDefault;
}

}  // namespace rift::sweep
