#pragma once
/// \file synthetic.hpp  The built-in rendered sequences: exact poses, exact depth, nothing to download.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "quadedge/camera.hpp"
#include "quadedge/image.hpp"
#include "quadedge/trajectory.hpp"

namespace quadedge {

/// What to render.
struct SyntheticOptions {
  std::string scene = "room";   ///< room: textured walls with objects in front of one another; cables: curved cables before a plain wall
  int frames = 60;
  int width = 942, height = 489;
  double focal = 541.764;       ///< px
  double baseline = 0.0598913;  ///< m
  double noise = 1.5;           ///< standard deviation of the camera noise [grey levels]
  int supersampling = 4;        ///< rays per pixel and axis
  std::uint64_t seed = 7;
};

/// One rendered view.
struct RenderedView {
  Image image;
  std::vector<float> depth;  ///< height x width, z of the ray through the pixel centre [m]
};

/// A deterministic renderer: the same options give the same bytes on every run.
class SyntheticSequence {
 public:
  /// \throws UsageError for an unknown scene or a size that cannot be rendered.
  explicit SyntheticSequence(const SyntheticOptions& options);
  ~SyntheticSequence();

  const StereoRig& rig() const;
  int frames() const;
  std::int64_t stamp_ns(int frame) const;                  ///< 20 frames per second
  Eigen::Isometry3d world_from_left(int frame) const;      ///< exact; the first one is the identity
  RenderedView render(int frame, bool right) const;
  double max_disparity() const;                            ///< px, for the nearest object of the scene

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace quadedge
