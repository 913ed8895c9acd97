#pragma once
/// \file corner_flow.hpp  Corners of a recorded image followed into another one in two dimensions, whatever the
/// calibration says: Lucas and Kanade 1981, with pyramids (Bouguet 2000) and a check back.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "quadedge/image.hpp"
#include "rig/patch_search.hpp"

namespace quadedge::rig {

/// An image and its reductions by 2, 4, 8 ..., grey levels only.
using FlowImage = std::vector<GreyPlane>;
FlowImage pyramid(const ImageView& recorded);

/// The strongest corner of each of about `count` cells, where it is one [px].
std::vector<Eigen::Vector2d> flow_corners(const FlowImage& image, int count);

/// Where a patch was found.
struct FlowMatch {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< [px]
  double correlation = 0;                        ///< of the patches at full resolution
};

/// Searches `to` for the patch of `from` around `at`, from `start` on, and from there back again; nothing if the way
/// back ends elsewhere.
std::optional<FlowMatch> follow(const FlowImage& from, const FlowImage& to, const Eigen::Vector2d& at,
                                const Eigen::Vector2d& start);

}  // namespace quadedge::rig
