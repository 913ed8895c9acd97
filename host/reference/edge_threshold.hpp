#pragma once
/// \file edge_threshold.hpp  The threshold of a frame's edges in plain C++. doc/method.md section 1.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/layouts.hpp"
#include "quadedge/config.hpp"
#include "quadedge/image.hpp"

namespace quadedge::reference {

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

}  // namespace quadedge::reference
