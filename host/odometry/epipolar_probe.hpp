#pragma once
/// \file epipolar_probe.hpp  Where spots of the left image lie in the right one, sought in both directions of the image
/// and not along the epipolar lines alone: the cascade of doc/method.md section 3 only ever sees what lies within half
/// a pixel of its line, and cannot say how far the rest is off.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "odometry/pinhole_view.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/image.hpp"

namespace quadedge::odometry {

/// A spot of the left image, found in the right one.
struct CornerMatch {
  Eigen::Vector2d left = Eigen::Vector2d::Zero();  ///< [px]
  double along = 0;        ///< position along the epipolar line from the point at infinity on [px]: the disparity
  double across = 0;       ///< distance from the line [px]
  double sigma = 0;        ///< standard deviation of `across` by the contrast of the patch [px]
  bool is_aligned = true;  ///< to a part of a pixel; else it was found among coarse pixels alone
  Eigen::Vector2d normal = Eigen::Vector2d::UnitY();  ///< of the line, in the direction of a growing `across`
  int edge = -1;                                      ///< the stereo edge, where it is one
};

/// Ways in which a right image may differ from what the calibration says, for the search.
enum class ImageTurn { none, mirrored, half, quarter, three_quarters };

/// What a search found.
struct ProbeSearch {
  int sought = 0;                  ///< spots
  std::vector<CornerMatch> found;  ///< in the right image and, from there, in the left one again
  int negative = 0;                ///< of the found ones, those whose right patch is a negative of the left one
  double max_disparity = 0;        ///< largest allowed disparity in the middle of the image [px]
};

/// Any rig; recorded images, distorted or not. Works on the host, on few spots.
class EpipolarProbe {
 public:
  /// \param max_disparity the largest that the cascade looks for [px], in the middle of the left image
  EpipolarProbe(const StereoRig& rig, double max_disparity);

  /// Aligns patches of about 240 of the stereo edges in both directions, starting where the cascade found
  /// them. A few pixels off are seen. Steady frames allocate nothing.
  void align(const StereoFrame& frame, const StereoEdges& edges, std::vector<CornerMatch>& spots) const;

  /// Seeks corners of the left image in the right one by normalised correlation: over a quarter of the image's width to
  /// both sides along the line, and a tenth of it across. Done on images of about 320 px width, which takes some ten
  /// milliseconds.
  ProbeSearch search(const StereoFrame& frame, ImageTurn turn = ImageTurn::none) const;

 private:
  /// An epipolar line in the right image.
  struct Line {
    Eigen::Vector2d infinity, direction, normal;
  };
  std::optional<Line> line(const Eigen::Vector2d& left) const;
  std::optional<Eigen::Vector2d> at_infinity(const Eigen::Vector2d& left) const;
  struct CoarseViews;
  CoarseViews coarse_views(const PinholeView& left, const PinholeView& right, ImageTurn turn) const;
  std::optional<CornerMatch> refine(const PinholeView& left, const PinholeView& right, const Eigen::Vector2d& spot,
                                    Eigen::Vector2d at) const;

  StereoRig rig_;
  double max_disparity_;
  Eigen::Matrix3d h_;  ///< K_R R0 K_L^-1: the right pixel of what lies at infinity
  Eigen::Vector3d t_;  ///< K_R T0
};

}  // namespace quadedge::odometry
