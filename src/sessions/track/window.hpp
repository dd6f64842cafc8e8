#pragma once

#include <memory>
#include <vector>

#include "rift/sessions/track/tracking.hpp"
#include "rift/view/track_view.hpp"

namespace rift::sessions {

/// What the window of a job shows beside the camera's picture. Throws as reading its path does.
view::TrackView::Content ContentOf(const TrackingJob& job);

/// The window, when the job wants one and there is a display; else says why there is none.
/// `camera` must outlive it.
std::unique_ptr<view::TrackView> WindowFor(const TrackingJob& job, const TrackingListener& listener,
                                           const vision::CameraModel& camera,
                                           const std::vector<int>& tag_ids,
                                           view::TrackView::Content content);

}  // namespace rift::sessions
