#include "support/processes/running_rift.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <stdexcept>

#include "support/inputs/trials.hpp"
#include "support/processes/child_end.hpp"
#include "support/tree.hpp"
#include "support/until.hpp"

extern char** environ;

namespace rift::test {
namespace {

bool IsRift(pid_t pid) {
  std::string name;
  return std::ifstream("/proc/" + std::to_string(pid) + "/comm") >> name && name == "rift";
}

}  // namespace

RunningRift::RunningRift(const std::vector<std::string>& arguments,
                         const std::string& redirection) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  const int flags = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, (folder_ / "out").c_str(), flags, 0600);
  posix_spawn_file_actions_addopen(&actions, 2, (folder_ / "err").c_str(), flags, 0600);
  std::vector<std::string> words{RiftBinary()};
  if (!redirection.empty()) {
    words.insert(words.begin(), {"/bin/sh", "-c", "exec \"$0\" \"$@\" " + redirection});
  }
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) {
    argv.push_back(word.data());
    command_ += (command_.empty() ? "" : " ") + word;
  }
  argv.push_back(nullptr);
  const int failed = posix_spawn(&pid_, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) throw std::runtime_error("cannot start " + RiftBinary());
}

RunningRift::~RunningRift() {
  if (!IsRunning()) return;
  Signal(SIGKILL);
  ::waitpid(pid_, &status_, 0);
}

void RunningRift::Signal(int signal) const {
  if (!is_over_) ::kill(pid_, signal);  // its number may be another's by now
}

bool RunningRift::Freeze() {
  if (!IsRunning()) return false;
  Signal(SIGSTOP);
  if (::waitpid(pid_, &status_, WUNTRACED) != pid_) throw std::runtime_error("cannot stop rift");
  is_over_ = !WIFSTOPPED(status_);
  return !is_over_;
}

void RunningRift::Thaw() const { Signal(SIGCONT); }

std::vector<pid_t> RunningRift::Workers() const {
  const std::string task = "/proc/" + std::to_string(pid_) + "/task/" + std::to_string(pid_);
  std::ifstream file(task + "/children");
  std::vector<pid_t> workers;
  for (pid_t child = 0; file >> child;) {
    if (IsRift(child)) workers.push_back(child);
  }
  return workers;
}

bool RunningRift::IsRunning() {
  if (!is_over_) is_over_ = ::waitpid(pid_, &status_, WNOHANG) == pid_;
  return !is_over_;
}

std::string RunningRift::Out() const { return ReadFile(folder_ / "out"); }
std::string RunningRift::Err() const { return ReadFile(folder_ / "err"); }

void RunningRift::WaitUntil(const std::string& what, const std::function<bool()>& is_so) {
  bool is_in_vain = false;
  try {
    test::WaitUntil(what, [&] {
      const bool is_running = IsRunning();  // before the question: its last deed counts
      if (is_so()) return true;
      is_in_vain = !is_running;
      return is_in_vain;
    });
  } catch (const std::runtime_error&) {
    is_in_vain = true;
  }
  if (is_in_vain) GiveUp(what);
}

ProcessResult RunningRift::Wait() {
  if (!is_over_ && !EndsInTime(pid_)) GiveUp("its end");
  if (!is_over_) ::waitpid(pid_, &status_, 0);
  is_over_ = true;
  return {WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_), Out(), Err()};
}

void RunningRift::GiveUp(const std::string& what) {
  const bool was_running = IsRunning();
  if (was_running) {
    Signal(SIGKILL);
    ::waitpid(pid_, &status_, 0);
    is_over_ = true;
  }
  throw std::runtime_error("waited in vain for: " + what + "\n" + command_ +
                           (was_running ? " was killed" : " has ended") + "; it printed\n" + Out() +
                           "and on stderr\n" + Err());
}

namespace {

/// What is killed next.
enum class Target { kWorking, kWorker, kCommitted };

/// Kills `target` when its time has come; false when the sweep ended before.
bool Kill(RunningRift& running, Target target, const std::function<int()>& committed_trials,
          std::mt19937_64& generator) {
  const int before = committed_trials();
  std::vector<pid_t> workers;
  bool is_over = false;
  test::WaitUntil("a sweep is in the middle or over", [&] {
    const bool is_time =
        target == Target::kCommitted ? committed_trials() > before : !running.Workers().empty();
    if (!is_time && running.IsRunning()) return false;
    // Without workers it plans, writes or draws: it goes on until it has some, or to its end.
    is_over = !running.Freeze();
    if (!is_over) workers = running.Workers();
    if (!is_over && workers.empty()) running.Thaw();
    return is_over || !workers.empty();
  });
  if (is_over) return false;
  if (target != Target::kWorker) {
    running.Signal(SIGKILL);
  } else {
    ::kill(workers[generator() % workers.size()], SIGKILL);
    running.Thaw();
  }
  return true;
}

}  // namespace

KilledSweep SweepUnderFire(const std::vector<std::string>& arguments, int kills,
                           const std::function<int()>& committed_trials,
                           std::mt19937_64& generator) {
  constexpr Target kTargets[] = {Target::kWorking, Target::kWorker, Target::kCommitted};
  KilledSweep sweep;
  for (int killed = 0;;) {
    sweep.resumed_starts += committed_trials() > 0;
    RunningRift running(arguments);
    ++sweep.starts;
    while (killed < kills) {
      const Target target = kTargets[killed % 3];
      if (!Kill(running, target, committed_trials, generator)) break;
      ++killed;
      ++(target == Target::kWorker ? sweep.worker_kills : sweep.coordinator_kills);
      if (target != Target::kWorker) break;
    }
    sweep.last = running.Wait();
    if (sweep.last.exit_code != 128 + SIGKILL) return sweep;
  }
}

}  // namespace rift::test
