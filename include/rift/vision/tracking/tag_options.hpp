#pragma once

#include <array>
#include <string_view>

#include "rift/vision/tracking/tag_family.hpp"

namespace rift::vision {

/// What the robot drives on, as far as its tag's height and tilt are concerned.
enum class Ground {
  kFlat,   ///< tag parallel to the floor at `height_m`
  kBumps,  ///< the same within `bump_height_sigma_m` and `bump_tilt_sigma_rad`
  kFree,   ///< ramps and all else: height unknown, tilt within `tilt_sigma_rad`
};
constexpr std::array<std::string_view, 3> EnumNames(Ground) { return {"flat", "bumps", "free"}; }

/// Which tag is followed, and when a sighting of it is believed.
struct TagOptions {
  TagFamily family = TagFamily::k36h11;
  int id = 0;
  double size_m = 0.0475;
  double height_m = 0.03;
  Ground ground = Ground::kFlat;
  double flat_height_sigma_m = 2e-5;
  double flat_tilt_sigma_rad = 0.002;
  double bump_height_sigma_m = 0.002;
  double bump_tilt_sigma_rad = 0.05;
  double tilt_sigma_rad = 0.25;
  double off_floor_share = 0.008;
  int max_hamming = -1;
  double min_margin = 20.0;
  int least_contrast = 30;
  int acquire_decimate = 3;
  double search_px = 14.0;
  int region_decimate = 2;
  double region_margin = 0.55;
  int recheck_every = 150;
  int doubt_recheck_every = 10;
  double lost_after_s = 0.25;
  double reach_mps = 1.5;
  double reach_m = 0.05;
  double doubt_s = 3.0;
  double edge_sigma_px = 0.005;
  double shared_sigma_px = 0.02;
  double lens_sigma_px = 0.1;
  double max_fit_px = 0.6;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("family", self.family,
          "of the robot's tag, of reference tags and of the twin's (authors: tag36h11); noise may "
          "look like a tag16h5");
    field("id", self.id, 0, kLastTagId,
          "the robot's tag of the family (authors: 0): tag36h11 has 0 to 586, tag25h9 0 to 34, "
          "tag16h5 0 to 29, tagStandard41h12 0 to 2114");
    field("size_m", self.size_m, 0.005, 1.0,
          "side of the black square in m, the white border left out (authors: 0.0475); of "
          "tagStandard41h12 the side of the white square within the black ring, as in libapriltag");
    field("height_m", self.height_m, 0.0, 2.0,
          "of the tag above the floor; an error of 1 mm moves the pose by 1 mm times the tangent "
          "of the angle at which the tag is seen");
    field("ground", self.ground,
          "what the robot drives on: flat holds the tag to height_m and to the floor's tilt, bumps "
          "does so loosely, free (ramps) leaves both open. Needs a world frame set by tags or "
          "points");
    field("flat_height_sigma_m", self.flat_height_sigma_m, 1e-6, 1.0,
          "how far the tag's height scatters while the robot drives on a flat floor");
    field("flat_tilt_sigma_rad", self.flat_tilt_sigma_rad, 1e-4, 3.2, "the same of its tilt");
    field("bump_height_sigma_m", self.bump_height_sigma_m, 1e-6, 1.0, "the same on bumps");
    field("bump_tilt_sigma_rad", self.bump_tilt_sigma_rad, 1e-4, 3.2, "the same on bumps");
    field("tilt_sigma_rad", self.tilt_sigma_rad, 0.01, 3.2,
          "how far the tag may lean from the floor's normal where the ground is free (the trials' "
          "ramp: 0.24)");
    field("off_floor_share", self.off_floor_share, 1e-4, 1.0,
          "the tag is not on the floor, and its height and tilt are left free, where holding it "
          "there moves the corners by more than this share of its side, RMS, and by more than two "
          "lens_sigma_px");
    field("max_hamming", self.max_hamming, -1, 2,
          "wrong bits that are put up with; -1: 1, and of tag16h5 none");
    field("min_margin", self.min_margin, 0.0, 127.0,
          "least mean distance of a bit's grey value from the threshold");
    field("least_contrast", self.least_contrast, 5, 200,
          "grey values from the tag's black to its white at least; AprilTag's own 5 is below a "
          "webcam's noise and makes a search nine times as long");
    field("acquire_decimate", self.acquire_decimate, 1, 8,
          "AprilTag looks at every n-th pixel of a whole picture at first, n at most this; each "
          "further picture without the tag is searched finer, the third at full size");
    field("search_px", self.search_px, 4.0, 100.0,
          "n is smaller where the tag's side would have fewer of those pixels");
    field("region_decimate", self.region_decimate, 1, 8, "the same where the tag is expected");
    field("region_margin", self.region_margin, 0.2, 4.0,
          "how far around the expected tag is read, in sides of the tag");
    field("recheck_every", self.recheck_every, 0, 1'000'000,
          "tracked frames between searches of the whole picture for a second tag of this id; 0: "
          "never");
    field("doubt_recheck_every", self.doubt_recheck_every, 1, 1'000'000,
          "the same while it is not clear which tag of this id is the robot's");
    field("lost_after_s", self.lost_after_s, 0.0, 10.0,
          "no prediction from a sighting older than this");
    field("reach_mps", self.reach_mps, 0.01, 100.0,
          "a tag of this id that a robot of this speed cannot have reached is a doubtful one");
    field("reach_m", self.reach_m, 0.001, 10.0, "what is put up with beyond that");
    field("doubt_s", self.doubt_s, 0.0, 600.0,
          "sightings are ambiguous until no other tag of this id was seen for so long");
    field("edge_sigma_px", self.edge_sigma_px, 0.0, 5.0,
          "error of a corner beyond what the scatter of its edges shows (pixel shape, print)");
    field(
        "shared_sigma_px", self.shared_sigma_px, 0.0, 5.0,
        "the same of all corners together, of a tag of 20 px; it falls with the cube of the side");
    field("lens_sigma_px", self.lens_sigma_px, 0.001, 5.0,
          "what the calibration may be wrong by within one tag: weighs the corners against the "
          "floor");
    field("max_fit_px", self.max_fit_px, 0.05, 10.0,
          "largest RMS distance of edge points or corners from the fitted square");
  }
  /// Throws std::invalid_argument for an id that the family does not have.
  void Check() const { RequireTagId(id, family); }

  /// Of 16 bits hardly any combination is far from all codes of the family.
  int MaxHamming() const {
    if (max_hamming >= 0) return max_hamming;
    return family == TagFamily::k16h5 ? 0 : 1;
  }
};

}  // namespace rift::vision
