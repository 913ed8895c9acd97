/// \file rig_finding.cpp  A sentence per kind; the largest term of the fit names the likely cause.
#include "rig/rig_finding.hpp"

#include <cmath>

#include "common/printed.hpp"

namespace quadedge::rig {
namespace {

/// What mends what a finding doubts.
constexpr const char* kMends = " `quadedge calibrate` learns the calibration from a drive";

std::string number(double value, int decimals) { return printed("%.*f", decimals, value); }

std::string percent(double ratio) { return number(100 * ratio, 0) + " %"; }

std::string name(Side side) { return side == Side::left ? "left" : "right"; }

std::string name(ImageTurn turn) {
  switch (turn) {
    case ImageTurn::none: return "unchanged";
    case ImageTurn::mirrored: return "mirrored";
    case ImageTurn::half: return "rotated by 180 degrees";
    case ImageTurn::quarter: return "rotated by 90 degrees";
    case ImageTurn::three_quarters: return "rotated by -90 degrees";
  }
  return {};
}

std::string matched(const RigEvidence& evidence) {
  if (!(evidence.matched_ratio >= 0)) return {};
  return percent(evidence.matched_ratio) + " of the left edges have a match, ";
}

std::string corners_found(const RigFinding& finding) {
  return percent(finding.evidence.found_ratio) + " of " + std::to_string(finding.corners) +
         " corners of the left image are found in the right one";
}

std::string seen_across(const EpipolarFit& fit) {
  return "corners are found " + number(fit.residual, 1) + " px off their epipolar lines (" + number(fit.offset, 1) +
         " px in the middle of the image, changing by " + number(fit.slope_x, 1) + " px over its width and " +
         number(fit.slope_y, 1) + " px over its height)";
}

/// Likely cause of the distances from the lines.
std::string cause_across(const EpipolarFit& fit) {
  const double x = std::abs(fit.slope_x) / 2, y = std::abs(fit.slope_y) / 2, middle = std::abs(fit.offset);
  if (fit.scatter > 0.5 * fit.residual) {
    return "is the direction of the baseline or the right camera's yaw wrong, or are distorted images used with a "
           "pinhole calibration?";
  }
  if (y >= x && y >= middle) return "is a focal length in the calibration wrong?";
  if (x >= middle) return "is one camera rolled relative to the calibration?";
  return "is one camera pitched relative to the calibration, is its principal point wrong, or are left and right "
         "exchanged?";
}

/// What was measured in a frame that cannot be used, and the likely cause.
std::string seen_and_cause(const RigFinding& finding) {
  switch (finding.kind) {
    case RigFindingKind::negative_image:
      return corners_found(finding) + ", and " + percent(finding.inverted_ratio) +
             " as their negative; is one image a negative?";
    case RigFindingKind::turned_image:
      return corners_found(finding) + ", but most are found if it is " + name(finding.turn) + "; is the right image " +
             name(finding.turn) + "?";
    case RigFindingKind::negative_disparities:
      return percent(finding.evidence.negative_ratio) +
             " of the disparities are negative; are left and right exchanged, are the images mirrored, is the sign of "
             "the baseline wrong, or the right camera's yaw?";
    case RigFindingKind::far_off_lines: return seen_across(finding.fit) + "; " + cause_across(finding.fit);
    default:
      return corners_found(finding) +
             "; do both cameras see the same scene at the same time? is one image mirrored or rotated?";
  }
}

std::string delayed(const ImageDelay& delay) {
  const int frames = std::abs(delay.frames);
  const std::string by = std::to_string(frames) + (frames == 1 ? " frame" : " frames");
  return std::string(delay.frames > 0 ? "the right" : "the left") + " camera is " + by +
         " late: " + percent(delay.on_line) + " of the corners lie on their epipolar lines if the " +
         (delay.frames > 0 ? "right" : "left") + " images are taken " + by + " earlier, " +
         percent(delay.on_line_here) + " as the images are paired; pair them by their time of exposure";
}

/// Images that are bad are named where corners leave their lines, in place of the calibration.
std::string poor(const RigFinding& finding) {
  const std::string seen =
      finding.fit.samples == 0
          ? "; few corners are found in both images"
          : "; corners are found " + number(finding.fit.residual, 1) +
                " px off their epipolar lines, which says nothing about the calibration in such images";
  switch (finding.kind) {
    case RigFindingKind::saturated_images:
      return percent(finding.poor) + " of the corners lie beside saturated pixels" + seen +
             ": is the exposure too long?";
    case RigFindingKind::compressed_images:
      return "the images show the blocks of a strong compression, with steps " + number(finding.poor, 1) +
             " times as large between them as inside" + seen + ": can they be recorded with a higher quality?";
    default:
      return "the right image is " + number(finding.poor, 1) + " times as bright as the left one" + seen +
             ": do both cameras have the same exposure and gain?";
  }
}

std::string frozen(Side side) {
  const std::string camera = name(side), other = name(side == Side::left ? Side::right : Side::left);
  return "the " + camera + " image is identical to that of the previous frame, the " + other + " one is not: has the " +
         camera + " camera frozen?";
}

std::string interlaced(double ratio) {
  return "odd and even rows are shifted against one another in " + percent(ratio) +
         " of the left image's texture, so that poses are doubtful: is the video interlaced? ffmpeg -vf bwdif "
         "deinterlaces it";
}

std::string shared_lens(double focal, double k1) {
  const double excess = -focal / (1 + focal);
  const std::string lengths =
      "both cameras' focal lengths seem to be " + percent(std::abs(excess)) + " too " + (excess > 0 ? "long" : "short");
  const std::string distortion = "both cameras' distortion seems to be wrong, k1 by about " + number(std::abs(k1), 2);
  return "turns do not fit depths: " + (focal != 0 ? lengths : distortion) +
         "; were the images cropped, scaled, or taken in another sensor mode or under water? Calibrate the rig with "
         "images like these";
}

/// Where nothing moves, and what follows from it.
std::string static_text(const RigFinding& finding) {
  const auto from = finding.region.bounds.min(), to = finding.region.bounds.max();
  const bool is_masked = finding.kind == RigFindingKind::masked_region;
  return percent(finding.region.ratio) + " of the left image's texture, between columns " + number(from.x(), 0) +
         " and " + number(to.x(), 0) + " and rows " + number(from.y(), 0) + " and " + number(to.y(), 0) +
         ", does not move " +
         (is_masked
              ? "while the rest does: it is masked from here on, as a part of the vehicle or dirt; "
                "--odometry.auto_mask false keeps it"
              : "although it is nearer than most of what moves: is it part of the vehicle, or dirt? Use a mask to "
                "exclude it");
}

}  // namespace

Warning warning(const RigFinding& finding) {  // LONG: a sentence per kind
  const std::string camera = "the " + name(finding.camera) + " camera's ";
  switch (finding.kind) {
    case RigFindingKind::delayed_images: return {WarningKind::unsynchronised_cameras, delayed(finding.delay)};
    case RigFindingKind::saturated_images:
    case RigFindingKind::compressed_images:
    case RigFindingKind::uneven_images: return {WarningKind::poor_images, poor(finding)};
    case RigFindingKind::frozen_camera: return {WarningKind::doubtful_calibration, frozen(finding.camera)};
    case RigFindingKind::off_lines:
      return {WarningKind::doubtful_calibration, "the calibration is doubtful: " + matched(finding.evidence) +
                                                     seen_across(finding.fit) + "; " + cause_across(finding.fit) +
                                                     kMends};
    case RigFindingKind::beyond_range:
      return {WarningKind::small_disparity_range,
              percent(finding.evidence.beyond_ratio) + " of the corners exceed the maximum disparity, " +
                  number(finding.max_disparity, 1) +
                  " px: is stereo.max_disparity too small, or stereo.min_depth too large?"};
    case RigFindingKind::some_negative_disparities:
      return {WarningKind::negative_disparities,
              percent(finding.evidence.negative_ratio) +
                  " of the disparities are negative: is the right camera's yaw or principal point wrong?"};
    case RigFindingKind::late_camera:
      return {WarningKind::unsynchronised_cameras,
              "distances from the epipolar lines are proportional to the image motion: are the cameras out of sync, by "
              "about " +
                  number(std::abs(finding.time_offset), 1) + " frames?"};
    case RigFindingKind::repeated_images:
      return {WarningKind::repeated_images,
              "both images are identical to those of the previous frame: "
              "have both cameras frozen, or was a frame stored twice?"};
    case RigFindingKind::large_disparity_offset:
      return {
          WarningKind::large_disparity_offset,
          "all disparities seem to be off by " + number(finding.disparity_offset, 1) +
              " px, so that distances and the path length are doubtful: is the right camera's yaw or principal point "
              "wrong?" +
              kMends};
    case RigFindingKind::shared_lens:
      return {WarningKind::doubtful_lenses, shared_lens(finding.shared_focal, finding.shared_k1)};
    case RigFindingKind::interlaced: return {WarningKind::unsynchronised_cameras, interlaced(finding.combed_ratio)};
    case RigFindingKind::static_region:
    case RigFindingKind::masked_region: return {WarningKind::static_region, static_text(finding)};
    case RigFindingKind::long_baseline:
      return {WarningKind::implausible_calibration,
              "the baseline is " + number(finding.number, 3) + " m: is it given in millimetres?"};
    case RigFindingKind::short_baseline:
      return {WarningKind::implausible_calibration,
              "the baseline is " + number(finding.number, 6) + " m: is it given in metres?"};
    case RigFindingKind::focal_length:
      return {WarningKind::implausible_calibration,
              camera + "focal length is " + number(finding.number, 2) + " image widths: is it given in pixels?"};
    case RigFindingKind::pixel_shape:
      return {WarningKind::implausible_calibration,
              camera + "fx is " + number(finding.number, 2) + " times its fy: are the pixels really not square?"};
    case RigFindingKind::principal_point:
      return {WarningKind::implausible_calibration,
              camera + "principal point (" + number(finding.principal_point.x(), 1) + ", " +
                  number(finding.principal_point.y(), 1) + ") lies outside its image"};
    default:
      return {WarningKind::doubtful_calibration,
              "the images do not fit the calibration: " + matched(finding.evidence) + seen_and_cause(finding)};
  }
}

}  // namespace quadedge::rig
