#include "rift/sweep/run/slurm_shards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <thread>

#include "rift/files/files.hpp"
#include "rift/sweep/run/slurm.hpp"

namespace rift::sweep {
namespace {

namespace fs = std::filesystem;

// A file that another machine has renamed may be seen some time after its job has left the queue.
constexpr int kMostAbsent = 3;

/// What Slurm says to it helps nobody: the jobs end by themselves, and the next run takes them in.
void CancelOrSay(const std::string& job_name, const SlurmShards::Say& say) {
  constexpr double kLimit_s = 10.0;  // somebody waits for the end of the command
  try {
    CancelArrays(job_name, {.limit_s = kLimit_s});
  } catch (const std::runtime_error& error) {
    say(
        fmt::format("note: jobs named {0} may still be in the queue, where scancel --name={0} ends "
                    "them: {1}",
                    job_name, error.what()));
  }
}

}  // namespace

SlurmShards::SlurmShards(const fs::path& out, const SlurmOptions& options, std::string experiment,
                         Journal& journal, Watch watch)
    : out_(fs::absolute(out)),
      options_(options),
      experiment_(std::move(experiment)),
      journal_(journal),
      watch_(std::move(watch)) {}

bool SlurmShards::Resume() {
  std::vector<Group> groups;
  for (const JobArray& array : JobArray::Of(out_)) {
    const std::vector<std::string> names = array.OpenShards();
    if (names.empty()) continue;
    // The limits that it was submitted under stand in its experiment.
    Group group{.array = array,
                .job_name = array.JobName(),
                .limits = array.IsOf(experiment_) ? Limits::kOfNow : Limits::kOther};
    array.WriteScript(out_, options_);
    for (const std::string& name : names) {
      // Whoever submitted it is gone: not in the queue at the first look means not there.
      group.tasks.push_back({.name = name, .absent = kMostAbsent - 1});
      TakeIn(UnfinishedShardJournal(out_, name), group.limits);
    }
    groups.push_back(std::move(group));
  }
  return groups.empty() || Drive(std::move(groups));
}

bool SlurmShards::Run(const std::vector<Shard>& shards) {
  if (shards.empty()) return true;
  const auto size = static_cast<size_t>(options_.max_array_size > 0 ? options_.max_array_size
                                                                    : MaxArraySize(Patience()));
  std::vector<Group> groups;
  for (size_t begin = 0; begin < shards.size(); begin += size) {
    const auto first = shards.begin() + static_cast<std::ptrdiff_t>(begin);
    const size_t count = std::min(size, shards.size() - begin);
    groups.push_back(Write({first, first + static_cast<std::ptrdiff_t>(count)}));
  }
  return Drive(std::move(groups));
}

SlurmShards::Group SlurmShards::Write(const std::vector<Shard>& shards) const {
  JobArray array = JobArray::Next(out_);
  array.WriteScript(out_, options_);
  Group group{.array = array, .job_name = array.JobName(), .is_known = true};
  for (const std::string& name : array.Write(experiment_, shards)) {
    // Nobody has submitted it.
    group.tasks.push_back({.name = name, .absent = kMostAbsent, .may_be_useless = false});
  }
  return group;
}

bool SlurmShards::Drive(std::vector<Group> groups) {
  fs::create_directories(out_ /
                         "shards");  // jobs make none: without it nobody wants their journals
  try {
    while (true) {
      watch_.seen(Look(groups));
      std::erase_if(groups, [this](const Group& group) {
        const auto is_done = [](const Task& task) { return task.is_done; };
        if (!std::all_of(group.tasks.begin(), group.tasks.end(), is_done)) return false;
        std::vector<std::string> names;
        for (const Task& task : group.tasks) names.push_back(task.name);
        Cancel({group});  // a shard that is run twice may still be
        group.array.CleanUp(out_, names);
        return true;
      });
      if (groups.empty()) {
        files::RemoveAll(out_ / "shards");
        return true;
      }
      if (watch_.go_on()) {
        for (Group& group : groups) Submit(group);
      }
      if (!Wait(options_.poll_s)) {
        Cancel(groups);
        return false;
      }
    }
  } catch (...) {
    Cancel(groups);
    throw;
  }
}

ShardCounts SlurmShards::Look(std::vector<Group>& groups) {
  ShardCounts counts;
  for (Group& group : groups) LookAt(group, counts);
  journal_.SetNote("state", "running");
  journal_.Commit();  // which throws when the folder is gone
  return counts;
}

/// First the queue, then the files: what has left the queue has left its file.
void SlurmShards::LookAt(Group& group, ShardCounts& counts) {
  std::optional<std::map<int, SlurmTask>> queue;
  try {
    queue = QueuedTasks(group.job_name, Patience());
    group.is_known = queue_was_read_ = true;
  } catch (const SlurmBusy& busy) {
    Complain(busy.what());
  } catch (const std::runtime_error& error) {
    if (!queue_was_read_) throw;
    Complain(error.what());  // the arrays run on, and their files tell what is done
  }
  TakeIn(group);
  for (size_t i = 0; i < group.tasks.size(); ++i) {
    Task& task = group.tasks[i];
    ++counts.total;
    counts.done += task.is_done;
    if (!queue || task.is_done) continue;
    const auto queued = queue->find(static_cast<int>(i));
    if (queued == queue->end()) {
      ++task.absent;
      continue;
    }
    if (queued->second.IsGivenUp()) {
      GiveUp(group, i, queued->second);
      continue;
    }
    task.absent = 0;
    const bool is_pending = queued->second.IsWaiting();
    ++(is_pending ? counts.pending : counts.running);
    if (is_pending && counts.reason.empty()) counts.reason = queued->second.reason;
  }
}

/// It is submitted anew.
void SlurmShards::GiveUp(Group& group, size_t index, const SlurmTask& queued) {
  watch_.say(fmt::format("note: shard {} of {} {} that Slurm holds it ({}); it is submitted anew",
                         index, group.array.Folder().string(),
                         queued.LostItsNodes() ? "lost its node so often" : "failed to start, so",
                         queued.reason));
  try {
    CancelTask(queued, static_cast<int>(index), Patience());
    group.tasks[index].absent = kMostAbsent;
  } catch (const SlurmBusy& busy) {
    Complain(busy.what());
  }
}

void SlurmShards::TakeIn(Group& group) {
  for (Task& task : group.tasks) {
    if (!task.is_done) task.is_done = TakeIn(ShardJournal(out_, task.name), group.limits);
  }
}

/// What is damaged or missing in the journal of a shard is run here by whoever asked for the rows.
bool SlurmShards::TakeIn(const fs::path& journal, Limits limits) {
  std::error_code not_there;
  if (!fs::exists(journal, not_there)) return false;
  try {
    const Journal::Merged merged = journal_.Merge(journal, limits);
    if (merged.damaged > 0) {
      watch_.say(fmt::format(
          "note: {}: {} of its rows were damaged and are left out; what is missing is run again",
          journal.string(), merged.damaged));
    }
    if (merged.given_up > 0) {
      watch_.say(fmt::format(
          "note: {}: {} of its trials hung, crashed or ran out of memory, perhaps under other "
          "limits (run), and are left out; what is missing is run again",
          journal.string(), merged.given_up));
    }
    return true;
  } catch (const UselessJournal& error) {
    watch_.say(fmt::format("note: {}; its shard is run again", error.what()));
    fs::remove(journal, not_there);
    return false;
  }
}

/// Its task would end at once, however often it is submitted. What is missing then is run again by
/// whoever asked for the rows.
void SlurmShards::DropUseless(Group& group) {
  std::set<std::string> told;
  for (size_t i = 0; i < group.tasks.size(); ++i) {
    Task& task = group.tasks[i];
    if (task.is_done || task.absent < kMostAbsent || !task.may_be_useless) continue;
    const std::string reason = group.array.WhyUseless(i, task.name);
    if (reason.empty()) continue;
    task.is_done = true;
    if (told.insert(reason).second) {
      watch_.say(fmt::format("note: {}; what is missing is run again", reason));
    }
  }
}

void SlurmShards::Submit(Group& group) {
  if (!group.is_known || Clock::now() < not_before_) return;
  DropUseless(group);
  SlurmArray array{.name = group.job_name,
                   .tasks = {},
                   .script = group.array.Script(),
                   .logs = group.array.Folder(),
                   .folder = fs::current_path()};
  for (size_t i = 0; i < group.tasks.size(); ++i) {
    const Task& task = group.tasks[i];
    if (task.is_done || task.absent < kMostAbsent) continue;
    if (task.tries >= kMostTries) {
      throw std::runtime_error(fmt::format(
          "shard {} of {} was run {} times and left no journal; the last line of {}: {}", i,
          group.array.Folder().string(), task.tries, group.array.LogFile(i).string(),
          group.array.LastLine(i)));
    }
    if (static_cast<int>(array.tasks.size()) < most_at_once_) {
      array.tasks.push_back(static_cast<int>(i));
    }
  }
  if (array.tasks.empty()) return;
  try {
    const std::string job = SubmitArray(array, options_, Patience());
    group.array.NoteJob(job, IndexRanges(array.tasks));
    for (const int i : array.tasks) {
      Task& task = group.tasks[static_cast<size_t>(i)];
      ++task.tries;
      task.absent = 0;
      task.may_be_useless = true;
    }
    back_off_s_ = 0.0;
    complaint_.clear();
  } catch (const SlurmBusy& busy) {
    // It may have taken the array all the same: the queue will tell.
    constexpr double kLongest_s = 300.0;
    back_off_s_ = std::min(kLongest_s, std::max(options_.poll_s, 2.0 * back_off_s_));
    not_before_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                     std::chrono::duration<double>(back_off_s_));
    most_at_once_ = std::max(1, static_cast<int>(array.tasks.size()) / 2);
    group.is_known = false;
    Complain(busy.what());
  }
}

bool SlurmShards::Wait(double duration_s) const {
  const auto end = Clock::now() + std::chrono::duration<double>(duration_s);
  while (Clock::now() < end) {
    if (!watch_.go_on()) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return watch_.go_on();
}

void SlurmShards::Cancel(const std::vector<Group>& groups) const {
  for (const Group& group : groups) CancelOrSay(group.job_name, watch_.say);
}

void SlurmShards::Complain(const std::string& reason) {
  if (reason == complaint_ || !watch_.go_on()) return;
  complaint_ = reason;
  watch_.say(fmt::format("note: {}; trying again", reason));
}

bool SlurmShards::AreOpen(const fs::path& out) { return !JobArray::OpenOf(out).empty(); }

void SlurmShards::Forget(const fs::path& out, const Say& say) {
  for (const JobArray& array : JobArray::OpenOf(out)) CancelOrSay(array.JobName(), say);
  // Tasks that are being cancelled still write there.
  for (const char* name : {"slurm", "shards"}) {
    const std::error_code error = files::RemoveAll(out / name);
    if (!error) continue;
    throw std::runtime_error(
        fmt::format("cannot remove {}: {}", (out / name).string(), error.message()));
  }
}

std::optional<ShardCounts> ReadShardCounts(const fs::path& out, double limit_s) {
  ShardCounts counts;
  bool slurm_answers = true;  // whoever waits does not wait for each array
  for (const JobArray& array : JobArray::Of(out)) {
    const std::vector<std::string> names = array.OpenShards();
    if (names.empty()) continue;
    std::map<int, SlurmTask> queue;
    try {
      if (slurm_answers) queue = QueuedTasks(array.JobName(), {.limit_s = limit_s});
    } catch (const std::runtime_error&) {
      slurm_answers = false;
    }
    for (size_t i = 0; i < names.size(); ++i) {
      ++counts.total;
      const bool is_done = fs::exists(ShardJournal(out, names[i]));
      counts.done += is_done;
      const auto queued = queue.find(static_cast<int>(i));
      if (is_done || queued == queue.end()) continue;
      const bool is_pending = queued->second.IsWaiting();
      ++(is_pending ? counts.pending : counts.running);
      if (is_pending && counts.reason.empty()) counts.reason = queued->second.reason;
    }
  }
  if (counts.total == 0) return std::nullopt;
  return counts;
}

}  // namespace rift::sweep
