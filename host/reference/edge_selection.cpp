#include "reference/edge_selection.hpp"

#include <algorithm>
#include <cmath>

namespace quadedge::reference {
namespace {

// Single precision, so that the device makes the same decisions.
constexpr float kHalfAnOctave = 0.70710678F;

/// Directions of gradients are quantised by direction_code() of kernels/edge_detection.cl.
constexpr float kCodes = 255.5F;
float code_of(float ratio) { return std::rint((ratio + 1.0F) * kCodes); }

/// See kernels/edge_selection.cl.
struct Crossing {
  float row = 0, step = 0, sine = 0;
};

Crossing crossing(const SelectionArguments& arguments, const GradientMaxima& maxima, std::size_t i) {
  const float x = maxima.x[i], y = maxima.y[i], gx = maxima.gradient_x[i], gy = maxima.gradient_y[i];
  const bool steep = std::abs(gx) >= std::abs(gy);
  const float ratio = steep ? gy / gx : gx / gy;
  const float tangent_x = steep ? -ratio : 1.0F, tangent_y = steep ? 1.0F : -ratio;
  const EpipolarRows& rows = arguments.rows;
  const float depth = rows.forward_x * x + rows.forward_y * y + rows.forward_1;
  Crossing result;
  const float plane = (rows.across_x * x + rows.across_y * y + rows.across_1) / depth;
  const float bend_x = rows.bend_xx * x + rows.bend_xy * y, bend_y = rows.bend_yy * y;
  result.row = plane - (bend_x * x + bend_y * y);
  const float by_x = (rows.across_x - plane * rows.forward_x) / depth - (bend_x + rows.bend_xx * x),
              by_y = (rows.across_y - plane * rows.forward_y) / depth - (2.0F * bend_y + rows.bend_xy * x);
  const float rise = std::abs(tangent_x * by_x + tangent_y * by_y);
  result.step = rise;
  result.sine = rise / std::sqrt((1.0F + ratio * ratio) * (by_x * by_x + by_y * by_y));
  return result;
}

float density_of(float sine) {
  float density = 1.0F;
  while (sine < kHalfAnOctave * density && density > 0.0625F) density *= 0.5F;
  return density;
}

bool meets(const Crossing& at, float spacing, float width) {
  const float distance = at.row - spacing * std::rint(at.row / spacing), reach = 0.5F * width * at.step;
  return distance >= -reach && distance < reach;
}

/// From a sample of the rows.
double weight_of_all(const SelectionArguments& arguments, const GradientMaxima& maxima) {
  double sum = 0;
  for (std::size_t i = 0; i < maxima.x.size(); ++i) {
    if (maxima.row[i] % kSelectionSample != 0) continue;
    const Crossing at = crossing(arguments, maxima, i);
    if (at.sine >= arguments.min_sine)
      sum += kSelectionSample *
             static_cast<double>(std::rint(static_cast<float>(kSelectionUnit) * at.step / density_of(at.sine)));
  }
  return sum;
}

}  // namespace

GradientMaxima maxima_of(const ReferenceEdges& edges) {
  GradientMaxima maxima;
  maxima.row = edges.row;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    maxima.x.push_back(static_cast<float>(edges.peak_x[i]));
    maxima.y.push_back(static_cast<float>(edges.peak_y[i]));
    const double gx = edges.gradient_x[i], gy = edges.gradient_y[i];
    const bool steep = std::abs(gx) >= std::abs(gy);
    const float ratio = code_of(static_cast<float>(steep ? gy / gx : gx / gy)) / kCodes - 1.0F;
    maxima.gradient_x.push_back(steep ? 1.0F : ratio);
    maxima.gradient_y.push_back(steep ? ratio : 1.0F);
  }
  return maxima;
}

float selection_spacing(const SelectionArguments& left_arguments, const GradientMaxima& left,
                        const SelectionArguments& right_arguments, const GradientMaxima& right, int budget) {
  const double most = std::max(weight_of_all(left_arguments, left), weight_of_all(right_arguments, right));
  const float wanted = static_cast<float>(most) / (static_cast<float>(kSelectionUnit) * static_cast<float>(budget));
  return wanted > kClosestSelection ? std::rint(wanted * kSelectionSteps) / kSelectionSteps : 0.0F;
}

std::vector<std::uint8_t> kept_by_selection(const SelectionArguments& arguments, const GradientMaxima& maxima,
                                            float spacing) {
  std::vector<std::uint8_t> kept(maxima.x.size(), 1);
  if (spacing == 0.0F) return kept;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const Crossing at = crossing(arguments, maxima, i);
    const bool searched = arguments.slack > 1.0F;
    bool chosen = meets(at, spacing * density_of(at.sine), searched ? kSearchedWidth : 1.0F);
    if (searched) {
      for (const float sine : {at.sine * arguments.slack, at.sine / arguments.slack})
        chosen = chosen || meets(at, spacing * density_of(sine), kSearchedWidth);
    }
    kept[i] = at.sine >= arguments.min_sine && chosen ? 1 : 0;
  }
  return kept;
}

ReferenceEdges select_edges(const ReferenceEdges& edges, const std::vector<std::uint8_t>& kept) {
  ReferenceEdges result;
  const auto filter = [&](const auto& values, auto& chosen) {
    for (std::size_t i = 0; i < kept.size(); ++i)
      if (kept[i] != 0) chosen.push_back(values[i]);
  };
  filter(edges.x, result.x);
  filter(edges.y, result.y);
  filter(edges.direction, result.direction);
  filter(edges.strength, result.strength);
  filter(edges.scale_drift, result.scale_drift);
  filter(edges.gradient_x, result.gradient_x);
  filter(edges.gradient_y, result.gradient_y);
  filter(edges.peak_x, result.peak_x);
  filter(edges.peak_y, result.peak_y);
  filter(edges.column, result.column);
  filter(edges.row, result.row);
  std::int32_t count = 0;
  std::size_t i = 0;
  for (const auto first : edges.row_first) {
    for (; i < static_cast<std::size_t>(first); ++i) count += kept[i];
    result.row_first.push_back(count);
  }
  return result;
}

}  // namespace quadedge::reference
