#pragma once
/// \file edge_detection.hpp  Plain C++ twins of stage 2, third-order edges in double precision:
/// kernels/edge_threshold.cl, edge_detection.cl, edge_selection.cl and edge_mask.cl. doc/method.md section 1.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/layouts.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/image.hpp"

namespace quadedge::reference {

// The threshold of a frame's edges in plain C++. doc/method.md section 1.

/// Histograms of the gradient magnitude and of the response of the noise operator, in the bins of
/// kernels/edge_threshold.cl.
struct ContrastTally {
  std::array<std::int64_t, kGradientBins> gradients{};
  std::array<std::int64_t, kNoiseBins> responses{};

  /// Adds the lattice points of `image`.
  void add(const ImageView& image, double sigma);
  /// The magnitude that this ratio of the gradients exceeds [grey levels per px]; 0 without any.
  double gradient_exceeded_by(double ratio) const;
  /// Standard deviation of the noise [steps between the values that a pixel can have]: the median response divided by
  /// that of unit normal noise.
  double noise() const;
};

/// Determines the threshold frame by frame.
class EdgeThreshold {
 public:
  explicit EdgeThreshold(const EdgesConfig& config) : config_(config) {}

  /// The threshold of the next frame [grey levels per px], whose images these are: two, or a single one.
  /// \param known_noise in place of a measurement
  double next(const std::vector<ImageView>& images, std::optional<double> known_noise = std::nullopt);
  double noise() const { return noise_; }  ///< of that frame, standard deviation [grey levels]; 0 if not measured
  /// That a fifth of the frame exceeds [grey levels per px]; 0 if not measured.
  double gradient() const { return gradient_; }

 private:
  EdgesConfig config_;
  double threshold_ = 0, noise_ = 0, gradient_ = 0;
};

/// Edges in scan order, with the pixel that won the maximum test.
struct ReferenceEdges {
  std::vector<double> x, y;                    ///< pixels
  std::vector<double> direction;               ///< radians in (-pi, pi]; the bright side lies at (-sin, cos)
  std::vector<double> strength;                ///< peak gradient magnitude, grey levels per pixel
  std::vector<double> scale_shift;             ///< towards the bright side per unit of log(sigma), pixels
  std::vector<double> gradient_x, gradient_y;  ///< unit gradient at the pixel that won
  std::vector<double> peak_x, peak_y;          ///< the parabola's peak, before the Newton step, pixels
  std::vector<std::int32_t> column, row;       ///< of the pixel that won
  std::vector<std::int32_t> row_first;         ///< as in EdgeSet, size height + 1

  std::size_t size() const { return x.size(); }
};

/// Image gradient, grey levels per pixel, row-major.
struct GradientField {
  int width = 0, height = 0;
  std::vector<double> ix, iy;

  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
  }
  double magnitude(int column, int row) const;
};

/// The gradient magnitude at a pixel and one step ahead and behind along the gradient, linearly interpolated on the
/// ring of the eight neighbours; `step` is the distance of the two probes [px].
struct Probe {
  double magnitude = 0, ahead = 0, behind = 0, step = 1;
  double gx = 0, gy = 0;  ///< unit gradient

  /// Of equal neighbours along the gradient, only the first one is a maximum.
  bool is_maximum() const { return magnitude > behind && magnitude >= ahead; }
};

/// Derivatives of the smoothed image at one point, grey levels and pixels.
struct Derivatives {
  double ix, iy, ixx, ixy, iyy, ixxx, ixxy, ixyy, iyyy, ixxxx, ixxxy, ixxyy, ixyyy, iyyyy;
};

/// \throws UsageError for an empty image.
GradientField gradient_field(ImageView image, const EdgesConfig& config);

/// The pixel must not lie on the rim of the field and must have a gradient.
Probe probe_maximum(const GradientField& field, int column, int row);

/// Kernels re-centred at (x, y): 2 R + 2 taps per axis beginning at floor(x) - R. Grey levels are taken relative to the
/// mean of the four pixels around the point, because the truncated tails of an off-centre kernel would respond to the
/// absolute level.
Derivatives derivatives_at(ImageView image, double x, double y, double sigma);

/// Gradient of F = grad(I)^T Hess(I) grad(I), which is normal to the edge and points to its dark side (doc/method.md
/// section 1).
std::array<double, 2> gradient_of_f(const Derivatives& d);

/// Third-order edges of an image of any size (too small for the margin: none) whose gradient exceeds `threshold` [grey
/// levels per px]. max_edges is ignored.
ReferenceEdges detect_edges(const ImageView& image, const EdgesConfig& config, double threshold);

EdgeSet to_edge_set(const ReferenceEdges& edges);

/// The first `most` of them; the number of others is added to `dropped`.
EdgeSet first_edges(const ReferenceEdges& all, int most, int& dropped);

// Plain C++ twin of kernels/edge_selection.cl. doc/method.md section 1.

/// Maxima of the gradient of one image.
struct GradientMaxima {
  std::vector<float> x, y;                    ///< px
  std::vector<float> gradient_x, gradient_y;  ///< of any length
  std::vector<std::int32_t> row;              ///< of the pixel
};
GradientMaxima maxima_of(const ReferenceEdges& edges);

/// Distance of the lattice's lines by edges.budget and edges.max_spacing [px]; 0: all maxima of both images are kept.
float selection_spacing(const SelectionArguments& left_arguments, const GradientMaxima& left,
                        const SelectionArguments& right_arguments, const GradientMaxima& right,
                        const EdgesConfig& config);

/// Which maxima of an image become edges, one flag each.
std::vector<std::uint8_t> kept_by_selection(const SelectionArguments& arguments, const GradientMaxima& maxima,
                                            float spacing);

/// The edges whose flag is set, in their order.
ReferenceEdges select_edges(const ReferenceEdges& edges, const std::vector<std::uint8_t>& kept);

// Plain C++ twin of kernels/edge_mask.cl. doc/method.md section 1.

/// The edges that are not within `margin` [px] of hidden pixels, in their order; all of them without a mask.
ReferenceEdges outside_mask(const ReferenceEdges& edges, const PixelMask& mask, int margin);

}  // namespace quadedge::reference
