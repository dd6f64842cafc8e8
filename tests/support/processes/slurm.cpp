#include "support/processes/slurm.hpp"

#include <netinet/in.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <stdexcept>

#include "support/inputs/trials.hpp"
#include "support/processes/child_end.hpp"
#include "support/tree.hpp"
#include "support/until.hpp"

extern char** environ;

namespace rift::test {
namespace {

namespace fs = std::filesystem;

/// A process that dies with this one, in a process group of its own.
pid_t Spawn(std::vector<std::string> words, const std::string& log) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t pid = ::fork();
  if (pid < 0) throw std::runtime_error("cannot start " + words[0]);
  if (pid > 0) return pid;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::setpgid(0, 0);
  const bool is_quiet = std::freopen("/dev/null", "r", stdin) != nullptr &&
                        std::freopen(log.c_str(), "a", stdout) != nullptr &&
                        std::freopen(log.c_str(), "a", stderr) != nullptr;
  if (is_quiet) ::execvp(argv[0], argv.data());
  ::_exit(127);
}

void End(pid_t& pid, int signal) {
  if (pid <= 0) return;
  ::kill(pid, signal);
  if (!EndsInTime(pid)) ::kill(-pid, SIGKILL);
  ::waitpid(pid, nullptr, 0);
  pid = -1;
}

std::vector<std::string> LinesOf(const std::string& file) {
  std::ifstream stream(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// What a command prints, within kGiveUp.
std::string OutputOf(const std::string& command) {
  const std::string limit = "timeout " + std::to_string(kGiveUp.count()) + " ";
  FILE* const pipe = ::popen((limit + command + " 2>/dev/null").c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot run " + command);
  std::string text;
  std::array<char, 4096> bytes;
  while (const size_t n = std::fread(bytes.data(), 1, bytes.size(), pipe)) {
    text.append(bytes.data(), n);
  }
  ::pclose(pipe);
  return text;
}

bool Has(const std::string& program) {
  return !OutputOf("sh -c 'PATH=$PATH:/usr/sbin:/sbin command -v " + program + "'").empty();
}

/// Processes in whose environment both of these are set; slurmd's steps and tasks leave its group.
std::vector<pid_t> ProcessesWith(const std::string& one, const std::string& other) {
  std::vector<pid_t> found;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const int pid = std::atoi(entry.path().filename().c_str());
    if (pid <= 0 || pid == ::getpid()) continue;
    std::ostringstream entries;  // not by an iterator, which throws when a process has just ended
    entries << std::ifstream(entry.path() / "environ").rdbuf();
    const std::string set = '\0' + entries.str();  // each with a 0 behind it
    const auto has = [&](const std::string& text) {
      return set.find('\0' + text + '\0') != set.npos;
    };
    if (has(one) && (has(other) || other.empty())) found.push_back(pid);
  }
  return found;
}

bool IsFree(int port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in here{};
  here.sin_family = AF_INET;
  here.sin_port = htons(static_cast<std::uint16_t>(port));
  const bool is_free = ::bind(socket, reinterpret_cast<const sockaddr*>(&here), sizeof here) == 0;
  ::close(socket);
  return is_free;
}

}  // namespace

FakeSlurm::FakeSlurm()
    : path_("PATH", (folder_ / "bin") + ":" + std::getenv("PATH")),
      state_("FAKE_SLURM", folder_ / "state") {
  fs::create_directories(folder_ / "bin");
  for (const char* part : {"state/jobs", "state/queue", "state/pids"}) {
    fs::create_directories(folder_ / part);
  }
  const std::string script = SourceDir() + "/tests/support/processes/fake_slurm.sh";
  for (const char* name : {"sbatch", "squeue", "scancel", "scontrol"}) {
    fs::create_symlink(script, folder_ / (std::string("bin/") + name));
  }
  daemon_ = Spawn({script}, folder_ / "daemon.log");
}

FakeSlurm::~FakeSlurm() {
  WriteText(folder_ / "state/stop", "");
  if (!EndsInTime(daemon_)) ::kill(-daemon_, SIGKILL);
  ::waitpid(daemon_, nullptr, 0);
}

int FakeSlurm::Queued() const {
  int tasks = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder_ / "state/queue")) {
    ++tasks;
  }
  return tasks;
}

int FakeSlurm::KillTasks() {
  WriteText(folder_ / "state/requeue", "");
  int tasks = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "state/pids")) {
    pid_t group = 0;
    if (std::ifstream(entry.path()) >> group) tasks += ::kill(-group, SIGKILL) == 0;
  }
  return tasks;
}

void FakeSlurm::Hold(bool is_on) const {
  if (is_on) WriteText(folder_ / "state/hold", "");
  if (!is_on) fs::remove(folder_ / "state/hold");
}

void FakeSlurm::Refuse(int submissions) const {
  WriteText(folder_ / "state/refuse", std::to_string(submissions) + "\n");
}

std::vector<std::string> FakeSlurm::Submitted() const {
  return LinesOf(folder_ / "state/submitted");
}

std::vector<std::string> FakeSlurm::Cancelled() const {
  return LinesOf(folder_ / "state/cancelled");
}

std::optional<std::string> RealSlurm::WhyNot() {
  for (const char* program : {"slurmctld", "slurmd", "munged", "sbatch", "squeue"}) {
    if (!Has(program)) return std::string(program) + " is not installed";
  }
  if (::geteuid() != 0) return "slurmd must be started by root";
  return std::nullopt;
}

RealSlurm::RealSlurm() : config_("SLURM_CONF", folder_ / "slurm.conf") {
  for (const char* name : {"munge", "state", "spool_n1", "spool_n2"}) {
    fs::create_directories(folder_ / name);
  }
  fs::permissions(folder_ / "munge", fs::perms::owner_all);
  std::random_device random;
  // Below the ports that the system gives out by itself; another clone's tests may have some.
  do {
    port_ = 20000 + static_cast<int>(random() % 4000) * 3;
  } while (!IsFree(port_) || !IsFree(port_ + 1) || !IsFree(port_ + 2));
  std::string key(128, '\0');
  for (char& byte : key) byte = static_cast<char>(random());
  WriteText(folder_ / "munge/key", key);
  fs::permissions(folder_ / "munge/key", fs::perms::owner_read);
  const auto at = [this](const std::string& name) { return folder_ / name; };
  std::ostringstream config;
  config
      << "ClusterName=rift\nSlurmctldHost=localhost(127.0.0.1)\nSlurmUser=root\nSlurmdUser=root\n"
      << "AuthType=auth/munge\nAuthInfo=cred_expire=5,socket="
      << at("munge/socket")  // a task that is run again waits so long
      << "\nSlurmctldPort=" << port_ << "\nStateSaveLocation=" << at("state")
      << "\nSlurmdSpoolDir=" << at("spool_%n") << "\nSlurmctldPidFile=" << at("slurmctld.pid")
      << "\nSlurmdPidFile=" << at("slurmd_%n.pid") << "\nSlurmctldLogFile=" << at("slurmctld.log")
      << "\nSlurmdLogFile=" << at("slurmd_%n.log")
      << "\nProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nSelectType=select/cons_tres\n"
      << "SelectTypeParameters=CR_Core\nReturnToService=2\nMpiDefault=none\n"
      << "SwitchType=switch/none\nJobAcctGatherType=jobacct_gather/none\n"
      << "AccountingStorageType=accounting_storage/none\nKillWait=5\nSlurmdTimeout=5\n"
      << "SchedulerParameters=sched_min_interval=0,batch_sched_delay=0,sched_interval=1,"
      << "bf_interval=1\n"
      << "NodeName=n1,n2 NodeHostname=localhost NodeAddr=127.0.0.1 Port=[" << port_ + 1 << "-"
      << port_ + 2 << "] CPUs=2 State=UNKNOWN\n"
      << "PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP\n";
  WriteText(folder_ / "slurm.conf", config.str());
  munged_ = Spawn({"/usr/sbin/munged", "--foreground", "--force", "--key-file=" + at("munge/key"),
                   "--socket=" + at("munge/socket"), "--pid-file=" + at("munge/pid"),
                   "--log-file=" + at("munge/log"), "--seed-file=" + at("munge/seed")},
                  at("munged.out"));
  WaitUntil("munged listens", [&] { return fs::exists(at("munge/socket")); });
  controller_ = Spawn({"/usr/sbin/slurmctld", "-D"}, at("slurmctld.out"));
  StartNode(0);
  StartNode(1);
  WaitUntil("both nodes are idle",
            [] { return OutputOf("sinfo --noheader --format=%D --states=idle").starts_with("2"); });
}

void RealSlurm::StartNode(int node) {
  const std::string name = node == 0 ? "n1" : "n2";
  const Environment named("RIFT_TEST_NODE", name);  // inherited by the steps, not by the tasks
  nodes_[node] =
      Spawn({"/usr/sbin/slurmd", "-D", "-N", name}, folder_ / ("slurmd_" + name + ".out"));
}

int RealSlurm::KillTasks() {
  const std::string ours = "SLURM_CONF=" + (folder_ / "slurm.conf");
  if (ProcessesWith(ours, "SLURMD_NODENAME=n1").empty()) return 0;
  End(nodes_[0], SIGKILL);
  for (const pid_t step : ProcessesWith(ours, "RIFT_TEST_NODE=n1")) ::kill(step, SIGKILL);
  int tasks = 0;
  for (const pid_t task : ProcessesWith(ours, "SLURMD_NODENAME=n1")) {
    tasks += ::kill(task, SIGKILL) == 0;
  }
  StartNode(0);
  return tasks;
}

RealSlurm::~RealSlurm() {
  for (pid_t& node : nodes_) End(node, SIGKILL);
  End(controller_, SIGKILL);
  // Until none is left: one that was about to start another has done so.
  const std::string ours = "SLURM_CONF=" + (folder_ / "slurm.conf");
  for (int empty = 0; empty < 3; ::usleep(20'000)) {
    const std::vector<pid_t> left = ProcessesWith(ours, "");
    for (const pid_t pid : left) ::kill(pid, SIGKILL);
    empty = left.empty() ? empty + 1 : 0;
  }
  End(munged_, SIGTERM);
}

int RealSlurm::Queued() const {
  const std::string lines = OutputOf("squeue --noheader --array");
  return static_cast<int>(std::count(lines.begin(), lines.end(), '\n'));
}

}  // namespace rift::test
