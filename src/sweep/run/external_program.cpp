#include "rift/sweep/run/external_program.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <linux/sockios.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "last_error.hpp"
#include "rift/files/files.hpp"
#include "rift/sweep/run/machine_trouble.hpp"

namespace rift::sweep {
namespace {

constexpr const char* kErrors = "stderr.txt";
constexpr const char* kCannotRun = "cannot run ";
constexpr int kNotStarted = 127;

[[noreturn]] void CannotStart(int error) {
  throw MachineTrouble(fmt::format("cannot start a program: {}", strerror(error)));
}

/// The two ends of a socket.
struct Ends {
  files::Descriptor ours, theirs;
};

Ends SocketPair() {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) CannotStart(errno);
  return {files::Descriptor(ends[0]), files::Descriptor(ends[1])};
}

/// Closes all from 3 on but those.
void CloseAllBut(std::vector<int> kept) {
  std::sort(kept.begin(), kept.end());
  unsigned next = 3;
  for (const int descriptor : kept) {
    if (descriptor < 3) continue;
    const auto number = static_cast<unsigned>(descriptor);
    if (number > next) ::close_range(next, number - 1, 0);
    next = number + 1;
  }
  ::close_range(next, ~0U, 0);
}

void SetLimits(int memory_mb) {
  const rlim_t most = static_cast<rlim_t>(memory_mb) << 20;
  const auto lower = [](int what, rlim_t limit) {
    rlimit now{};
    ::getrlimit(static_cast<__rlimit_resource>(what), &now);
    now.rlim_cur = std::min(limit, now.rlim_max);
    now.rlim_max = now.rlim_cur;
    ::setrlimit(static_cast<__rlimit_resource>(what), &now);
  };
  lower(RLIMIT_DATA, most);
  lower(RLIMIT_FSIZE, most);
  lower(RLIMIT_CORE, 0);
}

/// False where errno says why.
bool Write(int file, const std::string& text) {
  for (size_t written = 0; written < text.size();) {
    const ssize_t n = ::write(file, text.data() + written, text.size() - written);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    written += static_cast<size_t>(n);
  }
  return true;
}

/// Not made durable: the folder is gone after the trial.
void WriteInto(const std::string& folder, const std::string& name, const std::string& text) {
  const std::string path = (std::filesystem::path(folder) / name).string();
  const files::Descriptor file(path, O_WRONLY | O_CREAT, 0600);
  if (file.IsOpen() && Write(file.Number(), text)) return;
  throw MachineTrouble(fmt::format("cannot write {}: {}", path, strerror(errno)));
}

/// What becomes the program.
[[noreturn]] void Become(const ProgramStart& start, const std::string& folder, int in,
                         int out) noexcept {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::setpgid(0, 0);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGCHLD}) {
    std::signal(signal, SIG_DFL);
  }
  const int no_folder = ::chdir(folder.c_str()) == 0 ? 0 : errno;
  const int nothing = ::open("/dev/null", O_RDWR);
  const int errors =
      no_folder == 0 ? ::open(kErrors, O_WRONLY | O_CREAT | O_APPEND, 0600) : nothing;
  ::dup2(start.talks ? in : nothing, 0);
  ::dup2(start.talks ? out : nothing, 1);
  ::dup2(errors, 2);
  CloseAllBut({});
  for (const auto& [name, value] : start.environment) ::setenv(name.c_str(), value.c_str(), 1);
  std::vector<char*> arguments;
  for (const std::string& argument : start.arguments) {
    arguments.push_back(const_cast<char*>(argument.c_str()));
  }
  arguments.push_back(nullptr);
  std::string reason = fmt::format("{}{}: ", kCannotRun, arguments[0]);
  reason.reserve(reason.size() + 256);  // under the limits there may be no memory
  SetLimits(start.memory_mb);
  if (no_folder == 0) ::execvp(arguments[0], arguments.data());
  reason.append(strerror(no_folder != 0 ? no_folder : errno)).append("\n");
  static_cast<void>(Write(2, reason));
  ::_exit(kNotStarted);
}

/// Empty for a process that has gone.
std::string StatOf(pid_t pid) {
  try {
    return files::ReadIfThere(fmt::format("/proc/{}/stat", pid)).value_or("");
  } catch (const std::exception&) {
    return "";
  }
}

/// Processes of which this one is the parent (proc(5), stat: the fourth field).
std::vector<pid_t> Children() {
  std::vector<pid_t> children;
  DIR* const all = ::opendir("/proc");
  if (all == nullptr) return children;
  while (const dirent* entry = ::readdir(all)) {
    const int pid = std::atoi(entry->d_name);
    if (pid <= 0) continue;
    const std::string stat = StatOf(pid);
    const size_t name_end = stat.rfind(')');
    if (name_end == stat.npos || name_end + 4 >= stat.size()) continue;
    if (std::atoi(stat.c_str() + name_end + 4) == ::getpid()) children.push_back(pid);
  }
  ::closedir(all);
  return children;
}

/// Kills generation after generation: the children of one that died are children of this process.
void KillDescendants() {
  while (true) {
    pid_t reaped = 0;
    while ((reaped = ::waitpid(-1, nullptr, WNOHANG)) > 0) {
    }
    if (reaped < 0 && errno == ECHILD) return;
    for (const pid_t child : Children()) ::kill(child, SIGKILL);
    while (::waitpid(-1, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
}

/// The last bytes of a file, `most` of them; empty where it cannot be read. What a program writes
/// has no bound, and what it puts in the place of the file may be anything.
std::string EndOf(const std::string& path, off_t most) {
  const files::Descriptor file(path, O_RDONLY | O_NONBLOCK);
  if (!file.IsOpen()) return "";
  std::string text(static_cast<size_t>(most), '\0');
  const off_t begin = std::max<off_t>(0, ::lseek(file.Number(), 0, SEEK_END) - most);
  const ssize_t n = ::pread(file.Number(), text.data(), text.size(), begin);
  text.resize(n > 0 ? static_cast<size_t>(n) : 0);
  return text;
}

/// Serves until the caller closes its end: tells it of the program's end.
[[noreturn]] void Keep(const ProgramStart& start, const std::string& folder, int control,
                       files::Descriptor in, files::Descriptor out) noexcept {
  ::setsid();
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) std::signal(signal, SIG_IGN);
  CloseAllBut({control, in.Number(), out.Number()});
  sigset_t child_signal;
  ::sigemptyset(&child_signal);
  ::sigaddset(&child_signal, SIGCHLD);
  ::sigprocmask(SIG_BLOCK, &child_signal, nullptr);
  const int ends = ::signalfd(-1, &child_signal, SFD_CLOEXEC | SFD_NONBLOCK);
  const pid_t program = ::fork();
  if (program == 0) Become(start, folder, in.Number(), out.Number());
  if (program < 0) {
    const int no_process = -errno;  // below every status of a process
    static_cast<void>(::send(control, &no_process, sizeof no_process, MSG_NOSIGNAL));
  }
  in = {};
  out = {};
  bool is_wanted = program > 0;
  while (is_wanted) {
    std::array<pollfd, 2> waiting{{{control, POLLIN, 0}, {ends, POLLIN, 0}}};
    if (::poll(waiting.data(), waiting.size(), -1) < 0) continue;
    signalfd_siginfo signal{};
    while (::read(ends, &signal, sizeof signal) > 0) {
    }
    int status = 0;
    for (pid_t pid = 0; (pid = ::waitpid(-1, &status, WNOHANG)) > 0;) {
      if (pid == program) is_wanted = ::send(control, &status, sizeof status, MSG_NOSIGNAL) > 0;
    }
    if (waiting[0].revents != 0) is_wanted = false;  // nothing is ever sent: it was closed
  }
  KillDescendants();
  std::error_code none;
  std::filesystem::remove_all(folder, none);
  ::_exit(0);
}

}  // namespace

std::string ShortWords(std::string text) {
  constexpr size_t kLongest = 200;
  text.resize(std::min(text.size(), text.find('\n')));
  if (text.size() <= kLongest) return text;
  size_t end = kLongest;
  const auto continues = [&] { return (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80; };
  while (end > kLongest - 3 && continues()) --end;
  text.resize(end);
  return text;
}

std::string ExternalProgram::MakeFolder() {
  std::error_code error;
  const std::filesystem::path temporary = std::filesystem::temp_directory_path(error);
  std::string path = (temporary / "rift-XXXXXX").string();
  if (!error && ::mkdtemp(path.data()) != nullptr) return path;
  const char* named = std::getenv("TMPDIR");
  throw MachineTrouble(fmt::format(
      "cannot make a temporary folder in {}: {}; set TMPDIR to a folder that can be written",
      named != nullptr ? named : "/tmp", error ? error.message() : strerror(errno)));
}

ExternalProgram::ExternalProgram(const ProgramStart& start, std::string folder)
    : folder_(std::move(folder)), owner_(::getpid()) {
  if (start.arguments.empty()) throw std::runtime_error("a program has no name");
  Ends control, in, out;
  try {
    for (const auto& [name, text] : start.files) WriteInto(folder_, name, text);
    control = SocketPair();
    if (start.talks) {
      in = SocketPair();
      out = SocketPair();
    }
    keeper_ = ::fork();
    if (keeper_ < 0) CannotStart(errno);
  } catch (const MachineTrouble&) {
    std::error_code none;
    std::filesystem::remove_all(folder_, none);
    throw;
  }
  if (keeper_ == 0) {
    Keep(start, folder_, control.theirs.Number(), std::move(in.theirs), std::move(out.theirs));
  }
  control_ = std::move(control.ours);
  to_program_ = std::move(in.ours);
  from_program_ = std::move(out.ours);
}

ExternalProgram::~ExternalProgram() {
  for (files::Descriptor* ours : {&control_, &to_program_, &from_program_}) *ours = {};
  while (keeper_ > 0 && ::waitpid(keeper_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

ExternalProgram::Exit ExternalProgram::Wait() {
  int status = 0;
  ssize_t n = 0;
  do {
    n = ::recv(control_.Number(), &status, sizeof status, MSG_WAITALL);
  } while (n < 0 && errno == EINTR);
  if (n != sizeof status) return {0, SIGKILL};  // somebody killed the keeper
  if (status < 0) CannotStart(-status);
  if (WIFSIGNALED(status)) return {0, WTERMSIG(status)};
  return {WEXITSTATUS(status), 0};
}

bool ExternalProgram::WasNeverStarted(const Exit& exit, const std::string& last_words) {
  return exit.code == kNotStarted && last_words.starts_with(kCannotRun);
}

bool ExternalProgram::SendLine(const std::string& line) {
  const std::string bytes = line + '\n';
  for (size_t sent = std::exchange(has_begun_line_, false) ? 1 : 0; sent < bytes.size();) {
    const ssize_t n =
        ::send(to_program_.Number(), bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    sent += static_cast<size_t>(n);
  }
  return true;
}

std::optional<std::string> ExternalProgram::ReceiveLine() {
  constexpr size_t kLongest = size_t{64} << 20;
  size_t searched = 0;
  while (true) {
    const size_t end = arrived_.find('\n', searched);
    if (end != arrived_.npos) {
      std::string line = arrived_.substr(0, end);
      arrived_.erase(0, end + 1);
      return line;
    }
    searched = arrived_.size();
    if (searched > kLongest) return std::exchange(arrived_, "");
    // A child of the program may hold its output open for ever: its end is told by the keeper.
    std::array<pollfd, 2> waiting{
        {{from_program_.Number(), POLLIN, 0}, {control_.Number(), POLLIN, 0}}};
    if (::poll(waiting.data(), waiting.size(), -1) < 0) continue;
    std::array<char, 65536> bytes;
    const ssize_t n = ::recv(from_program_.Number(), bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0 && errno == EAGAIN && waiting[1].revents == 0) continue;
    if (n <= 0) return std::nullopt;
    arrived_.append(bytes.data(), static_cast<size_t>(n));
  }
}

void ExternalProgram::TakeArrived() {
  std::array<char, 65536> bytes;
  ssize_t n = 0;
  do {
    n = ::recv(from_program_.Number(), bytes.data(), bytes.size(), MSG_DONTWAIT);
  } while (n < 0 && errno == EINTR);
  if (n > 0) arrived_.append(bytes.data(), static_cast<size_t>(n));
}

const std::string& ExternalProgram::UnreadAtNextLine(char first, int most_ms) {
  using Clock = std::chrono::steady_clock;
  constexpr int kQuickLooks = 100;  // some 50 us: most programs read on at once
  if (!has_begun_line_) {
    has_begun_line_ = ::send(to_program_.Number(), &first, 1, MSG_NOSIGNAL) == 1;
  }
  const Clock::time_point end = Clock::now() + std::chrono::milliseconds(most_ms);
  for (int look = 0; most_ms < 0 || Clock::now() < end; ++look) {
    int on_its_way = 0;  // bytes, and what they cost
    const bool is_taken =
        ::ioctl(to_program_.Number(), SIOCOUTQ, &on_its_way) != 0 || on_its_way == 0;
    TakeArrived();
    if (is_taken || !arrived_.empty()) break;
    pollfd ended{control_.Number(), POLLIN, 0};
    if (::poll(&ended, 1, look < kQuickLooks ? 0 : 1) > 0) break;
  }
  return arrived_;
}

std::string ExternalProgram::LastWords() const {
  constexpr off_t kRead = 65536;
  std::string last = ErrorIn(EndOf((std::filesystem::path(folder_) / kErrors).string(), kRead));
  // Its name is drawn at random, and the same trial gives the same row.
  for (size_t at = last.find(folder_); at != last.npos; at = last.find(folder_, at)) {
    last.replace(at, folder_.size(), "{folder}");
  }
  return ShortWords(std::move(last));
}

void ExternalProgram::ForgetWords() {
  std::error_code none;
  std::filesystem::resize_file(std::filesystem::path(folder_) / kErrors, 0, none);
}

}  // namespace rift::sweep
