#pragma once
/// \file static_region.hpp  A part of the image that does not move while the rest does: a bonnet, a robot's arm, dirt.

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/undistortion.hpp"
#include "rig/corner_matching.hpp"

namespace quadedge::rig {

/// What was found in the left image.
struct StaticRegion {
  double ratio = 0;            ///< of the textured cells of the image
  Eigen::AlignedBox2d bounds;  ///< of the static cells [px]
  /// What is static and the gaps in it, if it certainly does not belong to the scene; else empty.
  PixelMask mask;
  bool is_released = false;  ///< what an earlier mask covers moves after all

  /// Where nothing moves, and what follows from it.
  std::string text() const;
};

/// Compares cells of the left image with the same cells some frames before, since anything moved. What is static
/// although it is nearer than what moves does not belong to the scene. A camera at rest and distant scenery do not
/// count as such a region. It is certain sooner if it is large and what changes lies on all sides, even if that is
/// nearer.
class StaticRegionDetector {
 public:
  /// Adds the next image. \param matches of this frame, whose depths are used
  /// \returns the region, at the end of each window of frames that has one; earlier in the window a certain one, with
  /// its mask, or that a mask is to be released
  std::optional<StaticRegion> observe(const PinholeView& left, const std::vector<CornerMatch>& matches);

 private:
  /// A cell of the image.
  struct Cell {
    bool is_textured = false;   ///< at the start of the window
    int changes = 0;            ///< comparisons in which the texture is another one
    double inverse_depths = 0;  ///< sum over the matches in this cell [1/m]
    int matches = 0;
  };

  void start(const PinholeView& left);
  void compare(const std::vector<float>& levels);
  bool is_at_rest() const;
  std::optional<StaticRegion> judge() const;
  PixelMask static_mask() const;
  bool masked_cells_move() const;
  Eigen::AlignedBox2d bounds(std::size_t cell) const;
  /// Index of the place at the upper left corner of a cell.
  std::size_t place_of(std::size_t cell) const;
  std::size_t reduced(std::size_t place) const;

  int columns_ = 0, rows_ = 0, width_ = 0, height_ = 0;
  std::vector<Cell> cells_;              ///< row-major
  std::vector<float> start_, current_;   ///< reduced grey levels at the start of the window, and now
  std::vector<std::uint8_t> is_static_;  ///< squares of a cell's size at places every kStaticStep px: so far
  int frames_ = 0;                       ///< since the start of the window
  PixelMask mask_;                       ///< of the last certain region
};

}  // namespace quadedge::rig
