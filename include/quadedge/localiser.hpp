#pragma once
/// \file localiser.hpp  Frames of another recording, or another camera, located in a saved map.

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "quadedge/map.hpp"

namespace quadedge {

/// Outcome of a localisation.
enum class LocalisationStatus {
  located,
  lost_too_few_edges,  ///< too few stereo edges in this frame
  lost_rig_mismatch,   ///< the images do not match the calibration
  lost_unknown_place,  ///< no keyframe of the map matches, or one alone with little support
  lost_ambiguous,      ///< more than one motion from a keyframe, or more than one place, explains the images
};
const char* to_string(LocalisationStatus status);

/// Where a frame was taken.
struct Localisation {
  std::int64_t stamp_ns = 0;
  LocalisationStatus status = LocalisationStatus::lost_unknown_place;
  /// Pose of the left camera in the frame of the map [m]; empty for a lost frame.
  std::optional<Eigen::Isometry3d> map_from_left;
  /// Covariance of that pose, due to edge and calibration errors; the pose of the keyframe counts as exact.
  std::optional<PoseCovariance> covariance;
  int key_rig = -1;          ///< number of the frame of the map's recording that it was located against
  int inliers = 0;           ///< quads with that keyframe that agree with the pose
  double support = 0;        ///< inliers divided by the kept edges that the pose brings into view
  bool is_followed = false;  ///< whether it was found near the prediction from the frames before
  std::string message;       ///< why a frame is lost; else empty
  /// Warnings that concern the whole recording. Those of one kind are reported with the first frame that has any.
  std::vector<Warning> warnings;
  double latency_ms = 0;  ///< from images in host memory to the pose on the host, steady clock
};

/// Locates stereo frames in a map (doc/method.md section 10). Deterministic.
class Localiser {
 public:
  /// \param rig the cameras of the frames, which may differ from the map's. If their resolution is at least one and a
  /// half times that of the map's cameras, the images are reduced. \param device must outlive the object \param follow
  /// search near a prediction first, after two located frames in a row; otherwise every frame is located by itself
  /// \throws DataError for an unusable rig; UsageError for an invalid configuration, or one whose edges and descriptors
  /// differ from the map's; DeviceError
  Localiser(const SavedMap& map, const StereoRig& rig, Device& device, const Config& config = {}, bool follow = false);
  ~Localiser();

  /// \throws DataError for images that do not fit the rig; DeviceError
  Localisation locate(const StereoFrame& frame);

  /// The configuration in effect.
  const Config& config() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace quadedge
