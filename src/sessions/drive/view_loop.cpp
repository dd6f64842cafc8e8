#include "view_loop.hpp"

#include <cstdlib>
#include <future>
#include <mutex>

namespace rift::sessions {
namespace {

/// The drive that is under way, from its begin to its end or the end of looking at it.
class UnderWay {
 public:
  UnderWay(const ViewedDrive& viewed, const std::shared_future<hardware::DriveRun>& run)
      : viewed_(viewed), run_(run) {
    const std::lock_guard lock(mutex);
    newest = this;
    // Each time anew, behind what the window has made by now: what was registered last comes first.
    std::atexit(&UnderWay::StopNewest);
  }
  ~UnderWay() {
    const std::lock_guard lock(mutex);
    newest = nullptr;
    if (!IsOver()) viewed_.stop();
  }
  UnderWay(const UnderWay&) = delete;
  UnderWay& operator=(const UnderWay&) = delete;

 private:
  bool IsOver() const {
    return run_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  }
  static void StopNewest() {
    const std::lock_guard lock(mutex);
    if (newest == nullptr || newest->IsOver()) return;
    newest->viewed_.stop();
    newest->run_.wait_for(newest->viewed_.patience);
  }

  static inline std::mutex mutex;  // of `newest`
  static inline const UnderWay* newest = nullptr;

  const ViewedDrive& viewed_;
  std::shared_future<hardware::DriveRun> run_;
};

}  // namespace

hardware::DriveRun DriveInView(const ViewedDrive& viewed) {
  const std::shared_future<hardware::DriveRun> run =
      std::async(std::launch::async, viewed.drive).share();
  const UnderWay under_way(viewed, run);  // goes before `run`, which waits for the drive
  while (run.wait_for(viewed.redraw) != std::future_status::ready) viewed.look();
  return run.get();
}

}  // namespace rift::sessions
