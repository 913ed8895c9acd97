#include "reference/photometric.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/layouts.hpp"

namespace quadedge::reference {
namespace {

constexpr double kRowStep = static_cast<double>(kPatchRowStep);

}  // namespace

PatchFrame patch_frame(double x, double y, double cosine, double sine, double side, double offset) {
  constexpr double kAlong = kRowStep * (kPatchRows / 2), kAcross = kPatchSide / 2;  // from the centre to the sample
  return {x + side * offset * sine - kAlong * cosine + kAcross * sine,
          y - side * offset * cosine - kAlong * sine - kAcross * cosine, cosine, sine};
}

double grey_at(const ImageView& image, double x, double y) {
  x = std::clamp(x, 0.0, static_cast<double>(image.width - 1));
  y = std::clamp(y, 0.0, static_cast<double>(image.height - 1));
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const int x1 = std::min(x0 + 1, image.width - 1), y1 = std::min(y0 + 1, image.height - 1);
  const double fx = x - x0, fy = y - y0;
  const auto grey = [&](int px, int py) { return static_cast<double>(image.at(px, py)); };
  return (1 - fy) * ((1 - fx) * grey(x0, y0) + fx * grey(x1, y0)) + fy * ((1 - fx) * grey(x0, y1) + fx * grey(x1, y1));
}

PatchValues cut_patch(const ImageView& image, const PatchFrame& frame, double dx, double dy) {
  PatchValues values{};
  double sum = 0;
  for (int i = 0; i < kPatchRows; ++i) {
    for (int j = 0; j < kPatchSide; ++j) {
      const double along = kRowStep * i;
      const double value = grey_at(image, frame.x + dx + along * frame.cosine - j * frame.sine,
                                   frame.y + dy + along * frame.sine + j * frame.cosine);
      values[static_cast<std::size_t>(kPatchSide * i + j)] = value;
      sum += value;
    }
  }
  for (auto& value : values) value -= sum / kPatchSamples;
  return values;
}

PatchValues patch_derivative(const ImageView& image, const PatchFrame& frame, double ex, double ey) {
  const PatchValues ahead = cut_patch(image, frame, 0.5 * ex, 0.5 * ey);
  PatchValues values = cut_patch(image, frame, -0.5 * ex, -0.5 * ey);
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = ahead[k] - values[k];
  return values;
}

double huber_weight(double residual, double limit) {
  return std::abs(residual) <= limit ? 1.0 : limit / std::abs(residual);
}

double patch_norm(const PatchValues& values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares);
}

double patch_ncc(const PatchValues& a, const PatchValues& b) {
  const double norms = patch_norm(a) * patch_norm(b);
  return norms < 1e-10 ? 0 : std::inner_product(a.begin(), a.end(), b.begin(), 0.0) / norms;
}

std::optional<Alignment> align_edge(const ImageView& image, const PatchFrame& moving, double ex, double ey,
                                    const PatchValues& fixed, const PatchValues& derivative, double stiffness,
                                    const RefinementSettings& settings) {
  double move = 0;
  for (int step = 0; step < settings.steps; ++step) {
    const PatchValues values = cut_patch(image, moving, move * ex, move * ey);
    const double gain = std::clamp(patch_norm(fixed) / std::max(patch_norm(values), 1e-3),
                                   1 / static_cast<double>(kGainMax), static_cast<double>(kGainMax));
    double curvature = stiffness, slope = -stiffness * move;
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double residual = fixed[k] - gain * values[k];
      const double weight = huber_weight(residual, settings.huber);
      curvature += weight * derivative[k] * derivative[k];
      slope += weight * derivative[k] * residual;
    }
    const double change = curvature < 1e-6 ? 0 : slope / curvature;
    move += change;
    if (!(std::abs(move) <= settings.clamp)) return std::nullopt;
    if (std::abs(change) < settings.tolerance) return Alignment{move, values};
  }
  return Alignment{move, cut_patch(image, moving, move * ex, move * ey)};
}

}  // namespace quadedge::reference
