#pragma once
/// \file frame_mask.hpp  Masks that come with a frame, transferred from the recorded to the pinhole image.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "quadedge/camera.hpp"
#include "quadedge/image.hpp"

namespace quadedge {

/// What the masks of a frame hide in the pinhole images; empty where a camera has none.
struct HiddenPixels {
  PixelMask left, right;

  bool empty() const { return left.empty() && right.empty(); }
};

/// Whether the pixel nearest to a position within the image is hidden.
bool hides(const PixelMask& mask, double x, double y);

/// Transfers the masks of one camera. Keeps where each pixel comes from, so that a frame costs a look-up per pixel.
class MaskTransfer {
 public:
  /// Hides the pixels of the view whose nearest pixel in the recorded image is 0 in `mask`; an empty mask hides none.
  void run(const ImageView& mask, const PinholeCamera& view, const UndistortionTable& table, PixelMask& hidden);

 private:
  void find_sources(const ImageView& mask, const UndistortionTable& table);

  std::vector<std::int32_t> source_;  ///< offset in a mask of `stride_`; empty for a camera without a table
  std::ptrdiff_t stride_ = 0;
};

}  // namespace quadedge
