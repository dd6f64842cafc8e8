#include "rift/sweep/run/worker_pool.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sched.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <stdexcept>

#include "rift/sweep/run/machine_trouble.hpp"
#include "worker.hpp"

namespace rift::sweep {
namespace {

using Clock = std::chrono::steady_clock;

// The job under way and the next: a worker never waits for the coordinator.
constexpr size_t kDepth = 2;
// A job whose worker was killed from outside is handed out again, but not for ever.
constexpr int kMostKills = 5;
constexpr int kTick_ms = 100;

std::string Times(int count) {
  if (count == 1) return "";
  return count == 2 ? ", twice" : fmt::format(", {} times", count);
}

}  // namespace

int CoresToUse() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  return ::sched_getaffinity(0, sizeof cores, &cores) == 0 ? CPU_COUNT(&cores) : 1;
}

/// A worker's place: the worker, when there is one, and the jobs it was given, oldest first.
struct WorkerPool::Slot {
  std::unique_ptr<Worker> worker;
  std::deque<Job> jobs;
  Clock::time_point busy_since;
};

WorkerPool::WorkerPool(Work work, int workers, const RunOptions& options)
    : work_(std::move(work)), options_(options) {
  if (workers < 1) throw std::invalid_argument(fmt::format("{} workers: at least 1", workers));
  slots_.resize(static_cast<size_t>(workers));
}

WorkerPool::~WorkerPool() = default;

bool WorkerPool::Run(const Batch& batch) {
  next_ = 0;
  open_ = 0;
  while (next_ < batch.count || open_ > 0) {
    if (!batch.go_on()) {
      KillAll();
      return false;
    }
    try {
      Feed(batch);
      Wait();
      for (Slot& slot : slots_) Collect(slot, batch);
    } catch (const MachineTrouble&) {
      KillAll();
      throw;
    }
  }
  return true;
}

/// Level by level, and the last jobs of a batch only to workers that are free, so that none of them
/// stands in line while another worker has nothing to do.
void WorkerPool::Feed(const Batch& batch) {
  for (size_t depth = 0; depth < kDepth; ++depth) {
    for (Slot& slot : slots_) {
      if (slot.jobs.size() > depth) continue;
      const size_t left = again_.size() + static_cast<size_t>(batch.count - next_);
      if (left == 0 || (depth > 0 && left <= slots_.size())) return;
      if (again_.empty()) {
        again_.push_back({next_, batch.job(next_)});
        ++next_;
        ++open_;
      }
      if (!slot.worker) slot.worker = std::make_unique<Worker>(work_, options_);
      if (slot.jobs.empty()) slot.busy_since = Clock::now();
      slot.worker->Send(again_.front().bytes);
      slot.jobs.push_back(std::move(again_.front()));
      again_.pop_front();
    }
  }
}

void WorkerPool::Wait() {
  std::vector<pollfd> waiting;
  for (const Slot& slot : slots_) {
    if (!slot.jobs.empty()) waiting.push_back({slot.worker->Descriptor(), POLLIN, 0});
  }
  if (::poll(waiting.data(), waiting.size(), kTick_ms) < 0 && errno != EINTR) {
    throw std::runtime_error(fmt::format("cannot wait for the workers: error {}", errno));
  }
}

void WorkerPool::Collect(Slot& slot, const Batch& batch) {
  if (!slot.worker) return;
  const bool is_alive = slot.worker->Receive();
  while (std::optional<JobResult> result = slot.worker->NextResult()) {
    const bool is_full = result->end == JobEnd::kOutOfMemory;
    if (is_full) return EndWorker(slot, result->end, result->bytes, batch);
    const int index = slot.jobs.front().index;
    slot.jobs.pop_front();
    slot.busy_since = Clock::now();
    --open_;
    batch.done(index, std::move(*result));
  }
  if (!is_alive) {
    const Worker::ExitStatus exit = slot.worker->Reap();
    const bool is_retried =
        exit.from_outside && !slot.jobs.empty() && ++slot.jobs.front().kills < kMostKills;
    if (is_retried) --slot.jobs.front().failures;
    return EndWorker(slot, exit.end, exit.reason, batch);
  }
  const std::chrono::duration<double> busy = Clock::now() - slot.busy_since;
  if (!slot.jobs.empty() && busy.count() > options_.timeout_s) {
    EndWorker(slot, JobEnd::kHung,
              fmt::format("had not ended after {:g} s (run.timeout_s)", options_.timeout_s), batch);
  }
}

/// The worker is gone, or goes; its oldest job has failed, the others are handed out again.
void WorkerPool::EndWorker(Slot& slot, JobEnd end, const std::string& reason, const Batch& batch) {
  slot.worker.reset();
  std::deque<Job> jobs = std::move(slot.jobs);
  slot.jobs.clear();
  if (jobs.empty()) return;
  const bool is_over = ++jobs.front().failures > options_.retries;
  if (is_over) {
    const Job job = std::move(jobs.front());
    jobs.pop_front();
    --open_;
    batch.done(job.index, {end, reason + Times(job.failures)});
  }
  again_.insert(again_.begin(), std::make_move_iterator(jobs.begin()),
                std::make_move_iterator(jobs.end()));
}

void WorkerPool::KillAll() {
  for (Slot& slot : slots_) {
    slot.worker.reset();
    slot.jobs.clear();
  }
  again_.clear();
}

}  // namespace rift::sweep
