/// \file side_patches.cpp  Interpolates grey levels and slopes; Gauss-Newton with Huber weights along one or two axes.
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

/// Cosine and sine of an edge's direction.
struct Turn {
  explicit Turn(float direction) : cosine(std::cos(direction)), sine(std::sin(direction)) {}
  float cosine, sine;
};

/// Calls visit(index, x, y) for every sample of the patch on a side (0 dark, 1 bright) of an edge at (x, y).
template <class Visit>
void for_samples(float x, float y, const Turn& turn, int side, double offset, const Visit& visit) {
  const float away = static_cast<float>(side == 0 ? -offset : offset);
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const auto along = static_cast<float>(i - kSide / 2), across = away + static_cast<float>(j - kSide / 2);
      visit(static_cast<std::size_t>(kLanes * i + j), x + along * turn.cosine - across * turn.sine,
            y + along * turn.sine + across * turn.cosine);
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

Picture::Picture(const ImageView& image) : width_(image.width), height_(image.height), stride_(width_ + 1) {
  const auto grey = [&](int x, int y) { return image.at(std::clamp(x, 0, width_ - 1), std::clamp(y, 0, height_ - 1)); };
  samples_.reserve(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height_ + 1));
  for (int row = 0; row <= height_; ++row) {
    for (int column = 0; column <= width_; ++column) {
      const int x = std::min(column, width_ - 1), y = std::min(row, height_ - 1);
      const auto across = [&](int dx) { return grey(x + dx, y - 1) + 2 * grey(x + dx, y) + grey(x + dx, y + 1); };
      const auto down = [&](int dy) { return grey(x - 1, y + dy) + 2 * grey(x, y + dy) + grey(x + 1, y + dy); };
      samples_.emplace_back(grey(x, y), (across(1) - across(-1)) / 8, (down(1) - down(-1)) / 8, 0.0F);
    }
  }
}

template <class Read>
auto Picture::interpolate(float x, float y, const Read& read) const {
  x = std::clamp(x, 0.0F, static_cast<float>(width_ - 1));
  y = std::clamp(y, 0.0F, static_cast<float>(height_ - 1));
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const float u = x - static_cast<float>(x0), v = y - static_cast<float>(y0);
  const Sample* a = samples_.data() + static_cast<std::ptrdiff_t>(y0) * stride_ + x0;
  return read(a[0], a[1], a[stride_], a[stride_ + 1], u, v);
}

Picture::Sample Picture::at(float x, float y) const {
  return interpolate(x, y, [](const Sample& a, const Sample& b, const Sample& c, const Sample& d, float u, float v) {
    const Sample top = a + u * (b - a), bottom = c + u * (d - c);
    return Sample(top + v * (bottom - top));
  });
}

float Picture::grey(float x, float y) const {
  return interpolate(x, y, [](const Sample& a, const Sample& b, const Sample& c, const Sample& d, float u, float v) {
    const float top = a[0] + u * (b[0] - a[0]), bottom = c[0] + u * (d[0] - c[0]);
    return top + v * (bottom - top);
  });
}

SidePatches cut_sides(const Picture& picture, const Place& edge, double offset) {
  SidePatches patches;
  const Turn turn(edge.direction);
  for (int side = 0; side < 2; ++side) {
    PatchValues& values = patches.sides[static_cast<std::size_t>(side)];
    values = {};
    for_samples(edge.x, edge.y, turn, side, offset,
                [&](std::size_t k, float x, float y) { values[k] = picture.grey(x, y); });
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

namespace {

using Doubles = std::array<double, std::tuple_size_v<PatchValues>>;

/// Residuals of a patch, and their Huber weights.
QUADEDGE_VECTOR_CLONES
void weigh(const PatchValues& goal, const PatchValues& seen, Doubles& residual, Doubles& weight) {
  for (std::size_t k = 0; k < goal.size(); ++k) {
    residual[k] = static_cast<double>(goal[k] - seen[k]);
    weight[k] = kRefinementHuber / std::max(std::abs(residual[k]), kRefinementHuber);
  }
}

/// Normal equations of a step, and the squares of its residuals.
template <int Unknowns>
struct Equations {
  using Vector = Eigen::Matrix<double, Unknowns, 1>;
  Eigen::Matrix<double, Unknowns, Unknowns> normal = Eigen::Matrix<double, Unknowns, Unknowns>::Zero();
  Vector pull = Vector::Zero();
  double squares = 0;

  void add(const PatchValues& goal, const Picture& picture, const Eigen::Vector2d& position, const Turn& turn, int side,
           const Eigen::Matrix<double, 2, Unknowns>& axes) {
    PatchValues xs, ys, seen{};
    std::array<PatchValues, Unknowns> slopes;
    for_samples(static_cast<float>(position.x()), static_cast<float>(position.y()), turn, side, kPaperRefinementOffset,
                [&](std::size_t k, float x, float y) {
                  xs[k] = x;
                  ys[k] = y;
                });
    const Eigen::Matrix<float, 2, Unknowns> directions = axes.template cast<float>();
    for (std::size_t i = 0; i < kSide * kSide; ++i) {
      const std::size_t k = i + i / kSide;
      const Picture::Sample sample = picture.at(xs[k], ys[k]);
      seen[k] = sample[0];
      for (int d = 0; d < Unknowns; ++d)
        slopes[static_cast<std::size_t>(d)][k] = sample[1] * directions(0, d) + sample[2] * directions(1, d);
    }
    subtract_mean(seen);
    for (auto& slope : slopes) subtract_mean(slope);
    Doubles residual, weight;
    weigh(goal, seen, residual, weight);
    for_indices([&](std::size_t k) {
      Vector slope;
      for (int d = 0; d < Unknowns; ++d) slope(d) = static_cast<double>(slopes[static_cast<std::size_t>(d)][k]);
      normal += weight[k] * slope * slope.transpose();
      pull += weight[k] * residual[k] * slope;
      squares += weight[k] * residual[k] * residual[k];
    });
  }
};

template <int Unknowns>
Refined refine_along(const SidePatches& fixed, const std::vector<Pairing>& pairings, const Picture& picture,
                     const Place& start, const Eigen::Matrix<double, 2, Unknowns>& axes,
                     const RefinementSettings& settings) {
  const double samples = static_cast<double>(kCount) * static_cast<double>(pairings.size());
  const Turn turn(start.direction);
  Refined result{{static_cast<double>(start.x), static_cast<double>(start.y)}, 0};
  for (int step = 0; step < settings.steps; ++step) {
    Equations<Unknowns> equations;
    for (const Pairing& pairing : pairings)
      equations.add(fixed.sides[static_cast<std::size_t>(pairing.first)], picture, result.position, turn,
                    pairing.second, axes);
    result.rms = std::sqrt(equations.squares / samples);
    if (Unknowns > 1) equations.normal.diagonal().array() += kDamping * samples;
    if (!(equations.normal.determinant() > kSingular)) break;
    const Eigen::Matrix<double, Unknowns, 1> change = equations.normal.inverse() * equations.pull;
    result.position += axes * change;
    if (change.norm() < settings.tolerance) break;
  }
  return result;
}

}  // namespace

Refined refine(const SidePatches& fixed, const std::vector<Pairing>& pairings, const Picture& picture,
               const Place& start, const Eigen::Matrix2Xd& axes, const RefinementSettings& settings) {
  return axes.cols() == 1 ? refine_along<1>(fixed, pairings, picture, start, axes, settings)
                          : refine_along<2>(fixed, pairings, picture, start, axes, settings);
}

}  // namespace quadedge::paper
