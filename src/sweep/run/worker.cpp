#include "worker.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <new>
#include <stdexcept>

#include "rift/files/process_end.hpp"
#include "rift/sweep/run/machine_trouble.hpp"

namespace rift::sweep {
namespace {

// A message is its length in four bytes, then itself; of an answer the first byte is a JobEnd, or
// says that there is none.
using Length = std::uint32_t;
constexpr char kMachineTrouble = 127;

std::string Framed(const std::string& message) {
  const auto length = static_cast<Length>(message.size());
  std::string framed(reinterpret_cast<const char*>(&length), sizeof length);
  return framed + message;
}

bool SendAll(int socket, const std::string& bytes) {
  size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t n = ::send(socket, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    sent += static_cast<size_t>(n);
  }
  return true;
}

bool ReceiveAll(int socket, char* bytes, size_t count) {
  while (count > 0) {
    const ssize_t n = ::recv(socket, bytes, count, 0);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes += n;
    count -= static_cast<size_t>(n);
  }
  return true;
}

std::string Answer(JobEnd end, const std::string& bytes) {
  return std::string(1, static_cast<char>(end)) + bytes;
}

std::string OneLine(std::string text, size_t longest) {
  text.resize(std::min({text.size(), longest, text.find('\n')}));
  return text;
}

// Of /proc/self/statm, in pages (proc(5)).
enum MemoryField { kResident = 2, kShared = 3, kData = 6 };

/// What the process holds already, in bytes.
rlim_t Held(MemoryField what) {
  std::array<char, 256> text{};
  const files::Descriptor file("/proc/self/statm", O_RDONLY);
  const ssize_t n = ::read(file.Number(), text.data(), text.size() - 1);
  unsigned long long field = 0;
  const char* at = text.data();
  for (int i = 0; n > 0 && i < what; ++i) {
    char* end = nullptr;
    field = std::strtoull(at, &end, 10);
    at = end;
  }
  return static_cast<rlim_t>(field) * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
}

void SetLimits(const RunOptions& options) {
  const rlim_t data = Held(kData) + (static_cast<rlim_t>(options.memory_mb) << 20);
  const rlimit data_limit{data, data}, no_core{0, 0};
  ::setrlimit(RLIMIT_DATA, &data_limit);
  ::setrlimit(RLIMIT_CORE, &no_core);
}

void CloseAllBut(int kept) {
  if (kept > 3) ::close_range(3, static_cast<unsigned>(kept) - 1, 0);
  ::close_range(static_cast<unsigned>(kept) + 1, ~0U, 0);
}

std::string Do(const WorkerPool::Work& work, const std::string& job) {
  try {
    return Answer(JobEnd::kDone, work(job));
  } catch (const std::bad_alloc&) {
    return Answer(JobEnd::kOutOfMemory, "");
  } catch (const MachineTrouble& trouble) {
    return kMachineTrouble + std::string(trouble.what());
  } catch (const std::exception& error) {
    return Answer(JobEnd::kThrew, error.what());
  }
}

[[noreturn]] void ServeJobs(const WorkerPool::Work& work, int socket) {
  std::string job;
  Length length = 0;
  while (ReceiveAll(socket, reinterpret_cast<char*>(&length), sizeof length)) {
    job.resize(length);
    if (!ReceiveAll(socket, job.data(), length)) break;
    if (::ftruncate(2, 0) != 0 || ::lseek(2, 0, SEEK_SET) < 0) break;
    const std::string answer = Do(work, job);
    if (!SendAll(socket, Framed(answer))) break;
    // Its heap is in pieces: the next job gets a worker as good as new.
    if (answer[0] == static_cast<char>(JobEnd::kOutOfMemory)) break;
  }
  ::_exit(0);
}

[[noreturn]] void RunWorker(const WorkerPool::Work& work, const RunOptions& options, int socket,
                            int output, pid_t coordinator) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != coordinator) ::_exit(0);
  std::signal(SIGINT, SIG_IGN);
  // What the coordinator does about signals is not for its copies.
  for (const int signal : {SIGTERM, SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL}) {
    std::signal(signal, SIG_DFL);
  }
  ::dup2(output, 1);
  ::dup2(output, 2);
  CloseAllBut(socket);
  SetLimits(options);
  ServeJobs(work, socket);
}

[[noreturn]] void CannotStart() {
  throw MachineTrouble(fmt::format("cannot start a worker process: {}", strerror(errno)));
}

}  // namespace

Worker::Worker(const WorkerPool::Work& work, const RunOptions& options) : options_(options) {
  std::array<int, 2> ends{};
  output_ = files::Descriptor(::memfd_create("rift_worker", MFD_CLOEXEC));
  if (!output_.IsOpen() || ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    CannotStart();
  }
  socket_ = files::Descriptor(ends[0]);
  const files::Descriptor theirs(ends[1]);
  const pid_t coordinator = ::getpid();
  pid_ = ::fork();
  if (pid_ == 0) RunWorker(work, options, theirs.Number(), output_.Number(), coordinator);
  if (pid_ < 0) CannotStart();
}

Worker::~Worker() {
  if (pid_ > 0) {
    ::kill(pid_, SIGKILL);
    while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
}

void Worker::Send(const std::string& job) { SendAll(socket_.Number(), Framed(job)); }

bool Worker::Receive() {
  std::array<char, 65536> bytes;
  while (true) {
    const ssize_t n = ::recv(socket_.Number(), bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno == EAGAIN || errno == EWOULDBLOCK;
    if (n == 0) return false;
    arrived_.append(bytes.data(), static_cast<size_t>(n));
  }
}

std::optional<JobResult> Worker::NextResult() {
  Length length = 0;
  if (arrived_.size() < sizeof length) return std::nullopt;
  std::memcpy(&length, arrived_.data(), sizeof length);
  if (arrived_.size() < sizeof length + length) return std::nullopt;
  JobResult result{static_cast<JobEnd>(arrived_[sizeof length]),
                   arrived_.substr(sizeof length + 1, length - 1)};
  arrived_.erase(0, sizeof length + length);
  if (result.end == static_cast<JobEnd>(kMachineTrouble)) throw MachineTrouble(result.bytes);
  if (result.end == JobEnd::kOutOfMemory) {
    result.bytes = fmt::format("wanted more than {} MB of memory", options_.memory_mb);
  }
  return result;
}

std::string Worker::StartOfOutput() const {
  constexpr size_t kLongest = 200;
  std::string text(kLongest, '\0');
  const ssize_t n = ::pread(output_.Number(), text.data(), text.size(), 0);
  text.resize(n > 0 ? static_cast<size_t>(n) : 0);
  return OneLine(text, kLongest);
}

Worker::ExitStatus Worker::Reap() {
  int status = 0;
  rusage usage{};
  while (::wait4(pid_, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  const std::string words = StartOfOutput();
  // It began with a copy of what is held here, which is no part of what it took.
  const auto began_kb = static_cast<long>((Held(kResident) - Held(kShared)) / 1024);
  const bool is_full = usage.ru_maxrss - began_kb > 9L * options_.memory_mb * 1024 / 10;
  if (is_full || words.find("bad_alloc") != words.npos) {
    return {JobEnd::kOutOfMemory,
            fmt::format("wanted more than {} MB of memory", options_.memory_mb)};
  }
  return {JobEnd::kCrashed, files::ProcessEndText(status, words),
          WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL};
}

}  // namespace rift::sweep
