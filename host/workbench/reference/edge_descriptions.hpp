#pragma once
/// \file edge_descriptions.hpp  Plain C++ twins of stage 3: what describes an edge.

#include <cstdint>
#include <optional>
#include <vector>

#include "common/layouts.hpp"
#include "common/stored_patch.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/image.hpp"

namespace quadedge::reference {

// Plain C++ twin of kernels/photometric.cl, double precision.

using quadedge::inverse_norm;
using quadedge::PatchValues;
using quadedge::store_side;
using quadedge::stored_side;

/// Where a patch lies: its first sample, rows of 7 samples along (-sine, cosine) to the bright side, 1 px apart, and
/// kPatchRowStep px along the tangent (cosine, sine) from row to row.
struct PatchFrame {
  double x, y, cosine, sine;
};

/// `side`: +1 dark, -1 bright, 0 on the edge itself; `offset` px from the edge to the patch centre.
PatchFrame patch_frame(double x, double y, double cosine, double sine, double side, double offset);

/// Bilinear grey level, coordinates clamped to the border.
double grey_at(const ImageView& image, double x, double y);

/// Mean-free grey levels of a patch moved by (dx, dy); element kPatchSide i + j.
PatchValues cut_patch(const ImageView& image, const PatchFrame& frame, double dx, double dy);

/// Mean-free derivative along the unit vector (ex, ey): central difference over 1 px [grey levels per px].
PatchValues patch_derivative(const ImageView& image, const PatchFrame& frame, double ex, double ey);

/// Settings of the Gauss-Newton loop.
struct RefinementSettings {
  int steps;
  double tolerance;  ///< px
  double huber;      ///< grey levels
  double clamp;      ///< px
};

/// Weight of the Huber loss.
double huber_weight(double residual, double limit);

/// Root of the sum of squares.
double patch_norm(const PatchValues& values);

/// NCC of two mean-free patches; 0 where one of them is flat.
double patch_ncc(const PatchValues& a, const PatchValues& b);

/// Result of the alignment of an edge.
struct Alignment {
  double move;         ///< px
  PatchValues values;  ///< the patch there, or less than the tolerance before it
};

/// Gauss-Newton on the move along (ex, ey) that makes the patch at `moving`, at equal contrast, look like `fixed`,
/// whose derivative along the move is `derivative` (doc/method.md section 3, 8b). A prior of `stiffness` [grey levels^2
/// / px^2] holds it around the start. \returns nothing if the move exceeds the clamp.
std::optional<Alignment> align_edge(const ImageView& image, const PatchFrame& moving, double ex, double ey,
                                    const PatchValues& fixed, const PatchValues& derivative, double stiffness,
                                    const RefinementSettings& settings);

// Plain C++ twin of kernels/patches.cl: the side patches and their similarity (doc/method.md section 2).

/// The two side patches of every edge, `kEdgePatchBytes` bytes per edge: row by row, each row of the dark patch
/// followed by the one of the bright patch, so that sixteen bytes loaded at once hold a row of both; then as two floats
/// 1 / norm of either patch, and eight zeros.
///
/// Sample (i, j) of the dark patch is byte 16 i + j, of the bright one 16 i + 8 + j; j = 7 is zero. i steps along the
/// tangent (cos t, sin t), j along the normal that points to the bright side (-sin t, cos t), kPatchRowStep
/// and 1 px per step; the middle sample (2, 3) lies `config.offset` px from the edge, on the dark side at (x + offset
/// sin t, y - offset cos t) and on the bright side opposite to it. Bilinear; coordinates outside the image are clamped
/// to its border. Each patch is made mean-free and stored by store_side(). `xs`, `ys` in pixels and `directions` in
/// radians have one entry per edge and must be finite.
std::vector<std::int8_t> side_patches(const ImageView& image, const std::vector<float>& xs,
                                      const std::vector<float>& ys, const std::vector<float>& directions,
                                      const PatchesConfig& config);

/// NCC of two edges from their patches (`kEdgePatchBytes` each), the highest over the four pairings of sides: sums of
/// products in integers, which are exact, multiplied in single precision by 1 / norm of `a` and then of `b`, so that
/// the kernels give the same bits.
float patch_ncc(const std::int8_t* a, const std::int8_t* b);

inline constexpr double kHistogramClip = 0.2;    ///< largest fraction of the norm in one bin of a descriptor
inline constexpr double kHistogramNorm = 512.0;  ///< norm of its stored bytes

// Plain C++ twin of kernels/wide_description.cl.

inline constexpr int kWideHalf = 7;            ///< samples on either side of the middle one
inline constexpr double kWideCellWidth = 3.0;  ///< small pixels: 9 px of the image

/// Means of blocks of kWideShrink x kWideShrink pixels; remaining pixels at the right and at the bottom are ignored.
struct SmallImage {
  int width = 0, height = 0;
  std::vector<float> pixels;
};
SmallImage shrink(const ImageView& image);

/// The surroundings of the left edge of every step-th stereo edge, kWideBytes each: gradients of the small image on a
/// grid of 15 x 15 samples (3 px apart, bilinear, border replicated) centred on the edge and turned with it, in 4 x 4
/// cells of 9 px, clipped and normalised as SIFT is (Lowe 2004, section 6). A gradient counts in each of eight
/// directions with its length times the cube of the positive part of its cosine with it, so that the descriptor changes
/// smoothly with rotation. Bytes [cell across][cell along][angle]; all zeros where the image is flat.
std::vector<std::uint8_t> wide_descriptions(const SmallImage& small, const StereoEdges& edges, int step);

// Plain C++ twin of kernels/sift.cl: the SIFT descriptors of both sides (doc/method.md section 2; Lowe 2004, section
// 6).

inline constexpr double kSiftAssumedSigma = 0.5;  ///< blur that a recorded image is taken to have [px]
inline constexpr double kSiftBaseSigma = 1.6;     ///< blur in which gradients are taken [px]
inline constexpr int kSiftBlurRadius = 6;         ///< taps on either side: 4 sigma of the blur that is added, rounded
inline constexpr double kSiftCellWidth = 1.5;     ///< px
inline constexpr int kSiftRadius = 5;  ///< half the sampling window [px]: cell width * (4 + 1) / sqrt(2), rounded

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
