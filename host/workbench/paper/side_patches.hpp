#pragma once
/// \file side_patches.hpp  Patches of 7 x 7 samples on both sides of an edge, their similarity, and the photometric
/// refinement of a position (paper section 5.1). Samples are 1 px apart, as in the code.

#include <Eigen/Core>
#include <array>
#include <vector>

#include "edges/paper_matches.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/image.hpp"

namespace quadedge::paper {

// Plain C++ twin of kernels/paper_patches.cl and kernels/paper_refinement.cl.

/// Seven rows of eight lanes, the last of which is zero; mean-free grey levels. Rows follow the tangent (cos t, sin t),
/// lanes the normal to the bright side (-sin t, cos t).
using PatchValues = std::array<float, 56>;

struct SidePatches {
  std::array<PatchValues, 2> sides;     ///< dark, bright
  std::array<float, 2> inverse_norm{};  ///< 0 for a flat patch, which is similar to none
};

/// Which side of one edge is compared with which side of another: 0 dark, 1 bright.
struct Pairing {
  int first = 0, second = 0;
  float ncc = -1;
};

inline const std::vector<Pairing> kBothSides = {{0, 0, 1}, {1, 1, 1}};

/// Grey levels of an image and their slopes (Sobel), read with bilinear interpolation and a replicated border.
class Picture {
 public:
  explicit Picture(const ImageView& image);
  /// Grey level, its slopes in x and y, and 0, to be interpolated at once.
  using Sample = Eigen::Vector4f;
  Sample at(float x, float y) const;
  float grey(float x, float y) const;

 private:
  template <class Read>
  auto interpolate(float x, float y, const Read& read) const;

  int width_, height_, stride_;
  std::vector<Sample> samples_;  ///< the last row and column are there twice
};

/// Both patches of an edge, centred `offset` px from it.
SidePatches cut_sides(const Picture& picture, const Place& edge, double offset);
/// The same for many edges, in parallel.
std::vector<SidePatches> cut_sides(const Picture& picture, const EdgePositionsView& edges, double offset);

/// The pairing with the highest NCC of the four; -1 if patches are flat.
Pairing best_pairing(const SidePatches& a, const SidePatches& b);

/// Settings of the refinement.
struct RefinementSettings {
  int steps;
  double tolerance;  ///< [px]
  bool both_sides;   ///< dark with dark and bright with bright, as in the code, or the most similar pairing
};
RefinementSettings refinement_settings(const StereoConfig& config);

/// A refined position, and what remains between the two patches.
struct Refined {
  Eigen::Vector2d position;  ///< [px]
  double rms = 0;            ///< weighted residual before the last step [grey levels]
};

/// Moves `start` along `axes` (one or two unit vectors, as columns) until its patches look like those of `fixed`:
/// Gauss-Newton on the differences of the mean-free patches of each pairing, with Huber weights. No move is rejected.
/// \param fixed cut kPaperRefinementOffset px from its edge, as are those that are moved
Refined refine(const SidePatches& fixed, const std::vector<Pairing>& pairings, const Picture& picture,
               const Place& start, const Eigen::Matrix2Xd& axes, const RefinementSettings& settings);

}  // namespace quadedge::paper
