#include "rift/sweep/run/job_array.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "rift/files/files.hpp"
#include "rift/files/shell_word.hpp"
#include "rift/statistics/hash.hpp"

namespace rift::sweep {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> LinesOf(const fs::path& path) {
  std::vector<std::string> lines;
  std::istringstream stream(files::ReadIfThere(path).value_or(""));
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Of the arrays' folders, by number.
std::vector<std::pair<int, fs::path>> Numbered(const fs::path& out) {
  std::vector<std::pair<int, fs::path>> arrays;
  std::error_code not_there;
  for (const auto& entry : fs::directory_iterator(out / "slurm", not_there)) {
    const std::string name = entry.path().filename().string();
    const bool is_number = name.find_first_not_of("0123456789") == name.npos && name.size() < 9;
    if (is_number && entry.is_directory()) arrays.emplace_back(std::stoi(name), entry.path());
  }
  std::sort(arrays.begin(), arrays.end());
  return arrays;
}

}  // namespace

std::vector<JobArray> JobArray::Of(const fs::path& out) {
  std::vector<JobArray> arrays;
  for (const auto& [number, folder] : Numbered(out)) arrays.emplace_back(folder);
  return arrays;
}

std::vector<JobArray> JobArray::OpenOf(const fs::path& out) {
  std::vector<JobArray> arrays = Of(out);
  std::erase_if(arrays, [](const JobArray& array) { return array.OpenShards().empty(); });
  return arrays;
}

JobArray JobArray::Next(const fs::path& out) {
  const auto arrays = Numbered(out);
  const int number = arrays.empty() ? 1 : arrays.back().first + 1;
  return JobArray(out / "slurm" / std::to_string(number));
}

fs::path JobArray::ShardFile(size_t task) const { return folder_ / fmt::format("{}.shard", task); }

fs::path JobArray::LogFile(size_t task) const { return folder_ / fmt::format("{}.log", task); }

std::string JobArray::LastLine(size_t task) const {
  const std::vector<std::string> lines = LinesOf(LogFile(task));
  const auto last = std::find_if(lines.rbegin(), lines.rend(),
                                 [](const std::string& line) { return !line.empty(); });
  return last == lines.rend() ? "nothing" : *last;
}

std::string JobArray::JobName() const {
  return "rift-" + statistics::Hash128Text(fs::weakly_canonical(folder_).string()).substr(0, 16);
}

std::vector<std::string> JobArray::OpenShards() const { return LinesOf(Index()); }

/// The index comes last: what was not written whole is not open.
std::vector<std::string> JobArray::Write(const std::string& experiment,
                                         const std::vector<Shard>& shards) {
  files::WriteFile(Experiment(), experiment);
  std::vector<std::string> names;
  std::string index;
  for (size_t task = 0; task < shards.size(); ++task) {
    const std::string encoded = EncodeShard(shards[task]);
    files::WriteFile(ShardFile(task), encoded);
    names.push_back(ShardName(encoded));
    index += names.back() + '\n';
  }
  files::WriteFile(Index(), index);
  return names;
}

void JobArray::WriteScript(const fs::path& out, const SlurmOptions& options) const {
  std::string script =
      "#!/bin/bash\n# A task of the job array of a sweep: one shard.\n"
      "[ -z \"${SLURM_TMPDIR:-}\" ] || export TMPDIR=\"$SLURM_TMPDIR\"\n";
  for (const std::string& line : options.prologue) script += line + '\n';
  const std::string program =
      options.program.empty() ? fs::read_symlink("/proc/self/exe").string() : options.program;
  script += fmt::format("exec {} sweep {} --out {} --shard {}/\"$SLURM_ARRAY_TASK_ID\".shard",
                        files::ShellQuoted(program), files::ShellQuoted(Experiment().string()),
                        files::ShellQuoted(out.string()), files::ShellQuoted(folder_.string()));
  // What is too large has been refused by whoever submits.
  script += fmt::format(" --jobs {} --copy-every {:g} --large-inputs\n", options.cpus_per_task,
                        options.copy_every_s);
  files::WriteFile(Script(), script);
}

void JobArray::NoteJob(const std::string& job, const std::string& tasks) const {
  const fs::path jobs = folder_ / "jobs";
  const std::string before = files::ReadIfThere(jobs).value_or("");
  files::WriteFile(jobs, before + fmt::format("{} {}\n", job, tasks));
}

bool JobArray::IsOf(const std::string& experiment) const {
  try {
    return files::ReadIfThere(Experiment()) == experiment;
  } catch (const std::exception&) {
    return false;
  }
}

std::string JobArray::WhyUseless(size_t task, const std::string& shard) const {
  const fs::path file = ShardFile(task);
  const auto is_other = [](const fs::path& path) {
    return path.string() + " is not there or not what was submitted";
  };
  try {
    const std::string bytes = files::ReadIfThere(file).value_or("");
    if (ShardName(bytes) != shard) return is_other(file);
    const std::string text = files::ReadIfThere(Experiment()).value_or("");
    const bool is_same = statistics::Hash128Text(text) == DecodeShard(bytes, file).experiment;
    return is_same ? "" : is_other(Experiment());
  } catch (const std::exception& error) {
    return error.what();
  }
}

void JobArray::CleanUp(const fs::path& out, const std::vector<std::string>& shards) const {
  std::error_code ignored;
  fs::remove(Index(), ignored);
  for (size_t task = 0; task < shards.size(); ++task) {
    fs::remove(ShardFile(task), ignored);
    if (fs::is_empty(LogFile(task), ignored)) fs::remove(LogFile(task), ignored);
    fs::remove(ShardJournal(out, shards[task]), ignored);
    fs::remove(UnfinishedShardJournal(out, shards[task]), ignored);
  }
  fs::remove(Experiment(), ignored);
}

}  // namespace rift::sweep
