#include "paper/side_patches.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "common/matching_constants.hpp"
#include "common/parallel.hpp"

namespace quadedge::paper {
namespace {

constexpr int kSide = 7, kLanes = 8;
constexpr float kCount = kSide * kSide;
constexpr double kFlat = 1e-10;     // sum of squares [grey levels^2] below which a patch has no NCC
constexpr double kSingular = 1e-8;  // smallest determinant of the equations
constexpr double kDamping = 1e-6;   // on the diagonal, per sample; with two unknowns

/// Calls visit(index, x, y) for every sample of the patch on a side (0 dark, 1 bright) of an edge.
template <class Visit>
void for_samples(const Place& edge, int side, double offset, const Visit& visit) {
  const float c = std::cos(edge.direction), s = std::sin(edge.direction);
  const float away = static_cast<float>(side == 0 ? -offset : offset);
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const auto along = static_cast<float>(i - kSide / 2), across = away + static_cast<float>(j - kSide / 2);
      visit(static_cast<std::size_t>(kLanes * i + j), edge.x + along * c - across * s, edge.y + along * s + across * c);
    }
  }
}

/// Calls visit(index) for the index of every sample.
template <class Visit>
void for_indices(const Visit& visit) {
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) visit(static_cast<std::size_t>(kLanes * i + j));
}

void subtract_mean(PatchValues& values) {
  float sum = 0;
  for_indices([&](std::size_t k) { sum += values[k]; });
  for_indices([&](std::size_t k) { values[k] -= sum / kCount; });
}

QUADEDGE_VECTOR_CLONES
float product(const PatchValues& a, const PatchValues& b) {
  std::array<float, kLanes> sums{};
  for (std::size_t i = 0; i < a.size(); i += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) sums[lane] += a[i + lane] * b[i + lane];
  return ((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7]));
}

}  // namespace

Picture::Picture(const ImageView& image) : width_(image.width), height_(image.height) {
  const auto grey = [&](int x, int y) { return image.at(std::clamp(x, 0, width_ - 1), std::clamp(y, 0, height_ - 1)); };
  samples_.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const auto across = [&](int dx) { return grey(x + dx, y - 1) + 2 * grey(x + dx, y) + grey(x + dx, y + 1); };
      const auto down = [&](int dy) { return grey(x - 1, y + dy) + 2 * grey(x, y + dy) + grey(x + 1, y + dy); };
      samples_.push_back({grey(x, y), (across(1) - across(-1)) / 8, (down(1) - down(-1)) / 8});
    }
  }
}

template <class Read>
auto Picture::interpolate(float x, float y, const Read& read) const {
  x = std::clamp(x, 0.0F, static_cast<float>(width_ - 1));
  y = std::clamp(y, 0.0F, static_cast<float>(height_ - 1));
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const float u = x - static_cast<float>(x0), v = y - static_cast<float>(y0);
  const Sample* a = samples_.data() + static_cast<std::ptrdiff_t>(y0) * width_ + x0;
  const std::ptrdiff_t right = x0 + 1 < width_ ? 1 : 0, below = y0 + 1 < height_ ? width_ : 0;
  return read(a[0], a[right], a[below], a[below + right], u, v);
}

Picture::Sample Picture::at(float x, float y) const {
  return interpolate(x, y, [](const Sample& a, const Sample& b, const Sample& c, const Sample& d, float u, float v) {
    const auto mix = [&](float p, float q, float r, float s) {
      const float top = p + u * (q - p), bottom = r + u * (s - r);
      return top + v * (bottom - top);
    };
    return Sample{mix(a.grey, b.grey, c.grey, d.grey), mix(a.slope_x, b.slope_x, c.slope_x, d.slope_x),
                  mix(a.slope_y, b.slope_y, c.slope_y, d.slope_y)};
  });
}

float Picture::grey(float x, float y) const {
  return interpolate(x, y, [](const Sample& a, const Sample& b, const Sample& c, const Sample& d, float u, float v) {
    const float top = a.grey + u * (b.grey - a.grey), bottom = c.grey + u * (d.grey - c.grey);
    return top + v * (bottom - top);
  });
}

SidePatches cut_sides(const Picture& picture, const Place& edge, double offset) {
  SidePatches patches;
  for (int side = 0; side < 2; ++side) {
    PatchValues& values = patches.sides[static_cast<std::size_t>(side)];
    values = {};
    for_samples(edge, side, offset, [&](std::size_t k, float x, float y) { values[k] = picture.grey(x, y); });
    subtract_mean(values);
    const float squares = product(values, values);
    patches.inverse_norm[static_cast<std::size_t>(side)] =
        static_cast<double>(squares) < kFlat ? 0.0F : 1.0F / std::sqrt(squares);
  }
  return patches;
}

std::vector<SidePatches> cut_sides(const Picture& picture, const EdgePositionsView& edges, double offset) {
  std::vector<SidePatches> patches(edges.size());
  for_row_blocks(edges.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      patches[i] = cut_sides(picture, {edges.x[i], edges.y[i], edges.direction[i]}, offset);
  });
  return patches;
}

Pairing best_pairing(const SidePatches& a, const SidePatches& b) {
  Pairing best;
  for (const auto& [first, second] : {std::pair(0, 0), std::pair(1, 1), std::pair(0, 1), std::pair(1, 0)}) {
    const auto p = static_cast<std::size_t>(first), q = static_cast<std::size_t>(second);
    const float norms = a.inverse_norm[p] * b.inverse_norm[q];
    const float ncc = norms > 0 ? product(a.sides[p], b.sides[q]) * norms : -1.0F;
    if (ncc > best.ncc) best = {first, second, ncc};
  }
  return best;
}

RefinementSettings refinement_settings(const StereoConfig& config) {
  return {config.refine_steps, config.refine_tolerance, config.refine_sides == "both"};
}

Refined refine(const SidePatches& fixed, const std::vector<Pairing>& pairings, const Picture& picture,
               const Place& start, const Eigen::Matrix2Xd& axes, const RefinementSettings& settings) {
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 2, 2>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2, 1>;
  const auto unknowns = axes.cols();
  const double samples = static_cast<double>(kCount) * static_cast<double>(pairings.size());
  Refined result{{static_cast<double>(start.x), static_cast<double>(start.y)}, 0};
  for (int step = 0; step < settings.steps; ++step) {
    const Place place{static_cast<float>(result.position.x()), static_cast<float>(result.position.y()),
                      start.direction};
    Matrix normal = Matrix::Zero(unknowns, unknowns);
    Vector pull = Vector::Zero(unknowns);
    double squares = 0;
    for (const Pairing& pairing : pairings) {
      const PatchValues& goal = fixed.sides[static_cast<std::size_t>(pairing.first)];
      PatchValues values{};
      std::array<PatchValues, 2> slopes{};
      for_samples(place, pairing.second, kRefinementOffset, [&](std::size_t k, float x, float y) {
        const Picture::Sample sample = picture.at(x, y);
        values[k] = sample.grey;
        for (Eigen::Index d = 0; d < unknowns; ++d)
          slopes[static_cast<std::size_t>(d)][k] =
              sample.slope_x * static_cast<float>(axes(0, d)) + sample.slope_y * static_cast<float>(axes(1, d));
      });
      subtract_mean(values);
      for (auto& slope : slopes) subtract_mean(slope);
      for_indices([&](std::size_t k) {
        const double residual = static_cast<double>(goal[k] - values[k]);
        const double weight = kRefinementHuber / std::max(std::abs(residual), kRefinementHuber);
        Vector slope(unknowns);
        for (Eigen::Index d = 0; d < unknowns; ++d)
          slope(d) = static_cast<double>(slopes[static_cast<std::size_t>(d)][k]);
        normal += weight * slope * slope.transpose();
        pull += weight * residual * slope;
        squares += weight * residual * residual;
      });
    }
    result.rms = std::sqrt(squares / samples);
    if (unknowns > 1) normal.diagonal().array() += kDamping * samples;
    if (!(normal.determinant() > kSingular)) break;
    const Vector change = normal.inverse() * pull;
    result.position += axes * change;
    if (change.norm() < settings.tolerance) break;
  }
  return result;
}

}  // namespace quadedge::paper
