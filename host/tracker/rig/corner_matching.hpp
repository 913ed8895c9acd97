#pragma once
/// \file corner_matching.hpp  Searches for corners of the left image in the right one, along and across the epipolar
/// lines. The cascade of doc/method.md section 3 only considers positions within half a pixel of the line and therefore
/// cannot measure larger deviations.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "geometry/epipolar_geometry.hpp"
#include "geometry/frame_mask.hpp"
#include "geometry/undistortion.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/image.hpp"
#include "rig/patch_search.hpp"

namespace quadedge::rig {

/// A corner of the left image, found in the right one.
struct CornerMatch {
  Eigen::Vector2d left = Eigen::Vector2d::Zero();  ///< [px]
  double along = 0;   ///< position along the epipolar line, measured from the point at infinity [px]: the disparity
  double across = 0;  ///< distance from the line [px]
  double sigma = 0;   ///< standard deviation of `across`, from the contrast of the patch [px]
  bool is_aligned = true;  ///< whether it was aligned with sub-pixel accuracy, not only found at the coarse resolution
  Eigen::Vector2d normal = Eigen::Vector2d::UnitY();  ///< of the line, in the direction of increasing `across`
  double inverse_depth = 0;                           ///< in the left camera, by `along` [1/m]
  Eigen::Vector2d right = Eigen::Vector2d::Zero();    ///< where it was found [px]
  bool is_unique = true;                              ///< whether no other place was found that looks alike
  std::optional<Eigen::Vector2d> motion =
      std::nullopt;  ///< displacement in the left image since the last frame, if searched [px]
};

/// Result of a search.
struct CornerSearch {
  int searched = 0;                ///< corners searched for
  std::vector<CornerMatch> found;  ///< found in the right image and, from there, again in the left one
  int aligned = 0, on_line = 0;    ///< of these: with sub-pixel accuracy, and then within kOnLine of their line
  int saturated = 0;               ///< further corners, beside saturated pixels, which are none of the scene's
  double brightness = 1;           ///< mean grey level of the right view over that of the left one
  double more_saturated = 0;       ///< difference between the fractions of saturated pixels of the views
  int negative = 0;                ///< matches whose right patch is the negative of the left one
  GreyPlane left_view;             ///< what the search read of the left image
};

/// For any rig and for recorded images with or without distortion. Runs on the host, on a small number of corners.
class CornerMatcher {
 public:
  /// \param rig must outlive the object
  explicit CornerMatcher(const StereoRig& rig);

  /// Aligns patches of about 240 stereo edges in both image directions, starting from the cascade's match. Detects
  /// deviations of a few pixels. Allocates nothing in steady state.
  void align(const StereoFrame& frame, const StereoEdges& edges, std::vector<CornerMatch>& matches) const;

  /// Searches for corners of the left image in the right one by normalised correlation: to both sides along the line
  /// over a quarter of the image width or 1.25 `max_disparity`, whichever is more, but at most half of the width, and
  /// over a tenth of the image height across it. Uses images reduced to a width of about 320 px.
  /// \param max_disparity maximum disparity of the cascade in the middle of the left image [px]
  /// \param every searches for every `every`-th corner, in `every`-th of the time
  /// \param hidden neither corners there are searched for, nor counts what is found there; what the rig masks likewise
  /// \param last the last frame's left view, in which the corners found are searched for, too; null: none
  CornerSearch search(const StereoFrame& frame, double max_disparity, std::size_t every = 1,
                      const HiddenPixels& hidden = {}, const GreyPlane* last = nullptr) const;

 private:
  /// An epipolar line in the right image.
  struct Line {
    Eigen::Vector2d infinity, direction, normal;
    double scale = 1;  ///< z of `infinity` in homogeneous coordinates

    /// Inverse depth [1/m] of a point at `along` [px] from `infinity`. \param t K_R T0
    double inverse_depth(double along, const Eigen::Vector3d& t) const {
      return along * scale / (direction.dot(t.head<2>()) - (direction.dot(infinity) + along) * t.z());
    }
  };
  std::optional<Line> line(const Eigen::Vector2d& left) const;
  std::optional<Eigen::Vector2d> at_infinity(const Eigen::Vector2d& left) const;
  struct CoarseViews;
  CoarseViews coarse_views(const PinholeView& left, const PinholeView& right) const;
  std::optional<CornerMatch> refine(const PinholeView& left, const PinholeView& right, const Eigen::Vector2d& corner_at,
                                    Eigen::Vector2d at) const;

  const StereoRig& rig_;
  Eigen::Matrix3d h_;  ///< K_R R0 K_L^-1: maps left pixels to the right pixels of points at infinity
  Eigen::Vector3d t_;  ///< K_R T0
};

}  // namespace quadedge::rig
