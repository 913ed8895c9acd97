#pragma once
/// \file sift.hpp  Plain C++ reference of the SIFT descriptors of both sides (doc/method.md section 2; Lowe 2004,
/// section 6).

#include <cstdint>
#include <vector>

#include "common/layouts.hpp"
#include "quadedge/config.hpp"
#include "quadedge/image.hpp"

namespace quadedge::reference {

inline constexpr double kSiftAssumedSigma = 0.5;  ///< blur that a recorded image is taken to have [px]
inline constexpr double kSiftBaseSigma = 1.6;     ///< blur in which gradients are taken [px]
inline constexpr int kSiftBlurRadius = 6;         ///< taps on either side: 4 sigma of the blur that is added, rounded
inline constexpr double kSiftCellWidth = 1.5;     ///< px
inline constexpr int kSiftRadius = 5;       ///< half the sampling window [px]: cell width * (4 + 1) / sqrt(2), rounded
inline constexpr double kSiftClip = 0.2;    ///< largest fraction of the norm in one bin
inline constexpr double kSiftNorm = 512.0;  ///< norm of the stored bytes

/// Length and angle of the central difference of the blurred image, height x width; zero length on the outermost
/// pixels.
struct GradientMap {
  int width = 0, height = 0;
  std::vector<double> magnitude;  ///< twice the slope, grey levels per px
  std::vector<double> angle;      ///< atan2(dI/dy, dI/dx), y down, radians
};

/// Blurs from the assumed to the base sigma (border reflected about the outermost pixel) and takes the gradient.
GradientMap sift_gradients(const ImageView& image);

/// One descriptor at (x, y) px, whose cells follow the direction (cos t, sin t); like OpenCV's it is centred on the
/// nearest pixel (half to even) and takes no sample from the outermost pixels. Byte order [cell across][cell
/// along][angle]: cells along the direction (cos t, sin t) and across along (-sin t, cos t), angle bins of 45 degrees
/// counted against the direction in which t grows. All zeros where there is no gradient at all.
void sift_descriptor(const GradientMap& map, float x, float y, float direction, std::uint8_t* descriptor);

/// Both descriptors of every edge, `kEdgeSiftBytes` per edge: at `config.offset` px on the dark side
/// (x + offset sin t, y - offset cos t), then on the bright side. `xs`, `ys` in pixels and `directions` in radians,
/// finite.
std::vector<std::uint8_t> sift_descriptors(const ImageView& image, const std::vector<float>& xs,
                                           const std::vector<float>& ys, const std::vector<float>& directions);

/// Square of the smallest L2 distance over the four pairings of two edges' descriptors (`kEdgeSiftBytes` each). Exact.
int sift_distance2(const std::uint8_t* a, const std::uint8_t* b);

}  // namespace quadedge::reference
