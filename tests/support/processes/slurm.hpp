#pragma once

#include <sys/types.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "support/processes/environment.hpp"
#include "support/processes/process.hpp"

namespace rift::test {

/// A cluster of this machine for the length of a scope: its commands are found by processes that
/// are started meanwhile. Nothing of it is left afterwards.
class Cluster {
 public:
  virtual ~Cluster() = default;
  Cluster() = default;
  Cluster(const Cluster&) = delete;
  Cluster& operator=(const Cluster&) = delete;

  /// Tasks in the queue, in any state.
  virtual int Queued() const = 0;
  /// Kills tasks that run, as a node that fails does; they are run again. How many there were.
  virtual int KillTasks() = 0;
};

/// Commands that run tasks as processes, in place of Slurm (fake_slurm.sh). Two run at once.
class FakeSlurm : public Cluster {
 public:
  FakeSlurm();
  ~FakeSlurm() override;

  int Queued() const override;
  int KillTasks() override;
  /// Tasks that are killed from now on are held, as after too many requeues.
  void Hold(bool is_on) const;
  /// The next submissions are refused for the moment.
  void Refuse(int submissions) const;
  /// The lines of arguments that sbatch, or scancel, was called with.
  std::vector<std::string> Submitted() const;
  std::vector<std::string> Cancelled() const;

 private:
  TemporaryFolder folder_;
  Environment path_, state_;
  pid_t daemon_ = -1;
};

/// A real slurmctld with two slurmd and a munged, on ports and sockets of its own.
class RealSlurm : public Cluster {
 public:
  /// Why it cannot be had on this machine; nothing where it can.
  static std::optional<std::string> WhyNot();

  /// Returns when both nodes are idle.
  RealSlurm();
  ~RealSlurm() override;

  int Queued() const override;
  /// All tasks of the first node with its slurmd; another slurmd takes its place.
  int KillTasks() override;

 private:
  std::string File(const std::string& name) const { return folder_ / name; }
  pid_t Start(const std::vector<std::string>& words, const std::string& log);
  void StartNode(int node);

  TemporaryFolder folder_;
  Environment config_;
  int port_ = 0;
  pid_t munged_ = -1, controller_ = -1;
  pid_t nodes_[2] = {-1, -1};
};

}  // namespace rift::test
