#pragma once
/// \file pair_collection.hpp  Pairs of stereo frames from a recording, frame by frame, for learning its rig.

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "calibration/corner_flow.hpp"
#include "calibration/pair_adjustment.hpp"
#include "quadedge/image.hpp"

namespace quadedge::rig {

/// Follows corners of one frame until the camera has moved, finds them in both right images, and begins again.
class PairCollector {
 public:
  /// \param unknowns must outlive the object
  /// \param disparity largest disparity of the scene [px]
  /// \param hides whether a pixel of a recorded image is not to be used; may be empty
  PairCollector(const RigUnknowns& unknowns, double disparity, std::function<bool(Side, const Eigen::Vector2d&)> hides);

  /// To be called with every frame in turn. \returns the pair that ends with this frame, if one does
  std::optional<FramePair> see(const StereoFrame& frame, int number);
  /// The next frame does not follow the last one.
  void restart() { first_.reset(); }

 private:
  /// A corner of the first frame on its way.
  struct Track {
    Eigen::Vector2d left, now, before;
    std::optional<Eigen::Vector2d> right;
  };
  struct First {
    int number = 0, age = 0;
    FlowImage left;
    std::vector<Track> tracks;
  };

  void begin(FlowImage left, const FlowImage& right, int number);
  void follow_tracks(const FlowImage& left);
  std::optional<FramePair> close(const FlowImage& left, const FlowImage& right, int number);
  std::optional<Eigen::Vector2d> find_right(const FlowImage& left, const FlowImage& right,
                                            const Eigen::Vector2d& at) const;
  Eigen::Vector2d predicted(const Track& track) const;
  double flow() const;

  const RigUnknowns& unknowns_;
  std::vector<double> disparities_;  ///< from which a right corner is searched [px]
  std::function<bool(Side, const Eigen::Vector2d&)> hides_;
  std::optional<First> first_;
  Eigen::Isometry3d per_frame_ = Eigen::Isometry3d::Identity();  ///< motion of the last pair
};

}  // namespace quadedge::rig
