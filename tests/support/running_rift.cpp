#include "support/running_rift.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <stdexcept>

#include "support/tree.hpp"
#include "support/trials.hpp"

extern char** environ;

namespace rift::test {
namespace {

/// Gnuplot, which draws the figures, is a child as well.
bool IsRift(pid_t pid) {
  std::string name;
  return std::ifstream("/proc/" + std::to_string(pid) + "/comm") >> name && name == "rift";
}

std::vector<pid_t> WorkersOf(pid_t pid) {
  const std::string task = "/proc/" + std::to_string(pid) + "/task/" + std::to_string(pid);
  std::ifstream file(task + "/children");
  std::vector<pid_t> workers;
  for (pid_t child = 0; file >> child;) {
    if (IsRift(child)) workers.push_back(child);
  }
  return workers;
}

void Pause(double longest_s, std::mt19937_64& generator) {
  const double pause_s = std::uniform_real_distribution<double>(0.0, longest_s)(generator);
  ::usleep(static_cast<useconds_t>(1e6 * pause_s));
}

}  // namespace

RunningRift::RunningRift(const std::vector<std::string>& arguments) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  const int flags = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, (folder_ / "out").c_str(), flags, 0600);
  posix_spawn_file_actions_addopen(&actions, 2, (folder_ / "err").c_str(), flags, 0600);
  std::vector<std::string> words{RiftBinary()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const int failed =
      posix_spawn(&pid_, RiftBinary().c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) throw std::runtime_error("cannot start " + RiftBinary());
}

RunningRift::~RunningRift() {
  if (!IsRunning()) return;
  Signal(SIGKILL);
  Wait();
}

void RunningRift::Signal(int signal) const { ::kill(pid_, signal); }

pid_t RunningRift::SignalWorker(int signal, std::mt19937_64& generator, pid_t spared) const {
  std::vector<pid_t> workers = WorkersOf(pid_);
  std::erase(workers, spared);
  if (workers.empty()) return 0;
  const pid_t worker = workers[generator() % workers.size()];
  ::usleep(20'000);  // a child that is about to become gnuplot is called rift until then
  if (!IsRift(worker)) return 0;
  return ::kill(worker, signal) == 0 ? worker : 0;
}

bool RunningRift::IsRunning() {
  if (!is_over_) is_over_ = ::waitpid(pid_, &status_, WNOHANG) == pid_;
  return !is_over_;
}

ProcessResult RunningRift::Wait() {
  if (!is_over_) ::waitpid(pid_, &status_, 0);
  is_over_ = true;
  return {WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_),
          ReadFile(folder_ / "out"), ReadFile(folder_ / "err")};
}

KilledSweep SweepUnderFire(const std::vector<std::string>& arguments, int kills,
                           double longest_pause_s, std::mt19937_64& generator) {
  KilledSweep sweep;
  while (true) {
    RunningRift running(arguments);
    ++sweep.starts;
    bool is_killed = false;
    while (!is_killed && sweep.coordinator_kills + sweep.worker_kills < kills) {
      Pause(longest_pause_s, generator);
      if (!running.IsRunning()) break;
      if (generator() % 2 == 0) {
        sweep.worker_kills += running.SignalWorker(SIGKILL, generator) != 0;
      } else {
        running.Signal(SIGKILL);
        ++sweep.coordinator_kills;
        is_killed = true;
      }
    }
    sweep.last = running.Wait();
    if (!is_killed) return sweep;
  }
}

}  // namespace rift::test
