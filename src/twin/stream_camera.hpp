#pragma once

#include <atomic>
#include <exception>
#include <mutex>
#include <optional>
#include <queue>
#include <random>
#include <thread>
#include <vector>

#include "mjpeg_server.hpp"
#include "rift/twin/twin.hpp"
#include "true_path.hpp"

namespace rift::twin {

/// When the middle of a picture's exposure is, and when it may be published. The simulated mocap's
/// processing_s is everything from the end of the exposure to the pose. A host reads the stream and
/// finds the tag in its own time, so the twin makes it wait for the rest alone.
double HoldBack_s(const simulation::MocapOptions& mocap, const TwinOptions& options);

/// Takes pictures of the true path in a thread of its own and publishes each when it is due. None
/// is made without a client.
class StreamCamera {
 public:
  /// `epoch_s`: the steady clock at simulated second 0. All must outlive it.
  StreamCamera(const TwinSetup& setup, vision::SyntheticCamera pictures, const TruePath& path,
               MjpegServer& server, const std::atomic<double>& epoch_s);
  ~StreamCamera();

  /// What went wrong in the thread, if anything did.
  void RethrowFailure() const;
  /// Ends the thread and adds what it knows to the run.
  void Finish(TwinRun& run);

 private:
  struct Picture {
    double due_s;
    std::vector<std::uint8_t> jpeg;
  };

  void Run(const std::stop_token& stop);
  void Take(double captured_s);
  void PublishDue(double now_s);
  double Now_s() const;

  simulation::MocapOptions mocap_;
  double fps_;
  double hold_back_s_;
  vision::SyntheticCamera pictures_;
  const TruePath& path_;
  MjpegServer& server_;
  const std::atomic<double>& epoch_s_;
  std::mt19937_64 generator_;
  std::queue<Picture> waiting_;
  trajectory::Trajectory tag_;
  std::vector<double> late_s_;
  double cpu_s_ = 0.0;
  mutable std::mutex mutex_;
  std::exception_ptr failure_;
  std::jthread thread_;  // last: it ends before what it uses
};

}  // namespace rift::twin
