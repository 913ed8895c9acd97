#pragma once
/// \file interlacing.hpp  Whether the odd and even rows of an image show different times, as in interlaced video.

#include "quadedge/image.hpp"

namespace quadedge::rig {

/// Textured cells of a recording that show a shift: sound ones have 0.03, JPEGs of any quality up to 0.1, and
/// recordings from whose frames interlaced ones were made 0.2 to 0.9.
constexpr double kInterlacedRatio = 0.15;

/// Cells of images with texture, and those of them whose odd rows are shifted along x against their even rows.
class Combing {
 public:
  void add(const ImageView& image);
  double ratio() const { return textured_ > 0 ? static_cast<double>(combed_) / textured_ : 0; }

 private:
  int textured_ = 0, combed_ = 0;
};

}  // namespace quadedge::rig
