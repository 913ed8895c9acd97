#include "pose/place_terms.hpp"

#include "common/row_blocks.hpp"
#include "common/vector_clones.hpp"

namespace quadedge::pose {

namespace {

constexpr std::size_t kPoseValues = 27,
                      kOffsetValues = 35;  ///< by pose; with by-offset: six with the pose, its square, its gradient

/// What all lanes share.
struct Shared {
  Shared(const Eigen::Isometry3d& motion, double offset_px, const StudentWeights& weights)
      : offset(offset_px), scale(weights.scale), dof(weights.dof) {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) rotation[r][c] = motion.linear()(r, c);
      translation[r] = motion.translation()(r);
    }
  }
  double rotation[3][3], translation[3];
  double offset, scale, dof;
};

struct Columns {
  explicit Columns(const PlaceTerms& terms) {
    for (int k = 0; k < PlaceTerms::kColumns; ++k) values[k] = terms.column(static_cast<PlaceTerms::Column>(k));
  }
  const double* values[PlaceTerms::kColumns];
};

/// What evaluate_lanes() writes; on the stack, so that nothing it reads can be meant.
template <std::size_t Values>
struct Lanes {
  double values[Values][kPlaceLanes];
  double depth[kPlaceLanes], error[kPlaceLanes];  ///< error -1: behind the camera
};

/// The residuals e (across, along, inverse depth), their derivatives g_r by the homogeneous point y, h by the own depth
/// in its standard deviations, o by the offset. With P = I - h h^T / (1 + h^2), what is left when the depth has been
/// eliminated, the sums over residuals
///   M = sum P_rs g_r g_s^T,  b = sum P_rs g_r e_s
/// give all: a step (w, v) moves y by w x y + rho v, so the matrix has the blocks [y] M [y]^T, rho [y] M, rho^2 M, the
/// gradient y x b, rho b.
template <std::size_t Values>
[[gnu::always_inline]] inline void evaluate_lanes(const Columns& columns, const double* depths, std::size_t first,
                                                  const Shared& shared, Lanes<Values>& lanes) {
  using T = PlaceTerms;
  const auto c = [&](T::Column which, std::size_t lane) { return columns.values[which][first + lane]; };
  const auto& r = shared.rotation;
  const auto& t = shared.translation;
  auto& values = lanes.values;
  for (std::size_t k = 0; k < kPlaceLanes; ++k) {
    const double rx = c(T::ray_x, k), ry = c(T::ray_y, k), sigma = c(T::inverse_depth_sigma, k), depth = depths[k];
    const double rho = c(T::inverse_depth, k) + depth * sigma;
    const double y0 = r[0][0] * rx + r[0][1] * ry + r[0][2] + rho * t[0];
    const double y1 = r[1][0] * rx + r[1][1] * ry + r[1][2] + rho * t[1];
    const double y2 = r[2][0] * rx + r[2][1] * ry + r[2][2] + rho * t[2];
    const bool in_front = y2 > 0;
    const double inverse = 1.0 / (in_front ? y2 : 1.0);
    const double u = y0 * inverse, v = y1 * inverse;
    const double du = u - c(T::place_x, k), dv = v - c(T::place_y, k);
    const double ax = c(T::across_x, k), ay = c(T::across_y, k), lx = c(T::along_x, k), ly = c(T::along_y, k);
    const double weight = c(T::inverse_depth_bar_weight, k);

    const double g00 = ax * inverse, g01 = ay * inverse, g02 = -(g00 * u + g01 * v);
    const double g10 = lx * inverse, g11 = ly * inverse, g12 = -(g10 * u + g11 * v);
    const double g22 = -rho * inverse * inverse * weight;
    const double d0 = g00 * t[0] + g01 * t[1] + g02 * t[2];
    const double d1 = g10 * t[0] + g11 * t[1] + g12 * t[2];
    const double d2 = g22 * t[2] + inverse * weight;
    const double h0 = d0 * sigma, h1 = d1 * sigma, h2 = d2 * sigma;
    const double per_pixel = c(T::inverse_depth_per_pixel, k);
    const double o0 = d0 * per_pixel, o1 = d1 * per_pixel,
                 o2 = d2 * per_pixel - weight * c(T::inverse_depth_bar_per_pixel, k);
    const double e0 = ax * du + ay * dv + o0 * shared.offset - h0 * depth;
    const double e1 = lx * du + ly * dv + o1 * shared.offset - h1 * depth;
    const double e2 = (rho * inverse - c(T::inverse_depth_bar, k)) * weight + o2 * shared.offset - h2 * depth;

    const double shrink = 1.0 / (1.0 + h0 * h0 + h1 * h1 + h2 * h2);
    const double he = h0 * e0 + h1 * e1 + h2 * e2, taken = shrink * he;
    const double cost = e0 * e0 + e1 * e1 + e2 * e2 - taken * he;
    const double believed = (shared.dof + kPlaceSize) / (shared.dof + cost / shared.scale) / shared.scale;
    const double w = in_front ? believed : 0.0;
    lanes.depth[k] = in_front ? -taken : depth;
    lanes.error[k] = in_front ? cost : -1.0;

    const double q0 = h0 * g00 + h1 * g10, q1 = h0 * g01 + h1 * g11, q2 = h0 * g02 + h1 * g12 + h2 * g22;
    const double m00 = w * (g00 * g00 + g10 * g10 - shrink * q0 * q0);
    const double m01 = w * (g00 * g01 + g10 * g11 - shrink * q0 * q1);
    const double m02 = w * (g00 * g02 + g10 * g12 - shrink * q0 * q2);
    const double m11 = w * (g01 * g01 + g11 * g11 - shrink * q1 * q1);
    const double m12 = w * (g01 * g02 + g11 * g12 - shrink * q1 * q2);
    const double m22 = w * (g02 * g02 + g12 * g12 + g22 * g22 - shrink * q2 * q2);
    const double b0 = w * (g00 * e0 + g10 * e1 - taken * q0);
    const double b1 = w * (g01 * e0 + g11 * e1 - taken * q1);
    const double b2 = w * (g02 * e0 + g12 * e1 + g22 * e2 - taken * q2);

    // [y] M, column by column.
    const double k00 = y1 * m02 - y2 * m01, k10 = y2 * m00 - y0 * m02, k20 = y0 * m01 - y1 * m00;
    const double k01 = y1 * m12 - y2 * m11, k11 = y2 * m01 - y0 * m12, k21 = y0 * m11 - y1 * m01;
    const double k02 = y1 * m22 - y2 * m12, k12 = y2 * m02 - y0 * m22, k22 = y0 * m12 - y1 * m02;
    values[0][k] = y1 * k02 - y2 * k01;
    values[1][k] = y2 * k00 - y0 * k02;
    values[2][k] = y0 * k01 - y1 * k00;
    values[3][k] = rho * k00;
    values[4][k] = rho * k01;
    values[5][k] = rho * k02;
    values[6][k] = y2 * k10 - y0 * k12;
    values[7][k] = y0 * k11 - y1 * k10;
    values[8][k] = rho * k10;
    values[9][k] = rho * k11;
    values[10][k] = rho * k12;
    values[11][k] = y0 * k21 - y1 * k20;
    values[12][k] = rho * k20;
    values[13][k] = rho * k21;
    values[14][k] = rho * k22;
    const double square = rho * rho;
    values[15][k] = square * m00;
    values[16][k] = square * m01;
    values[17][k] = square * m02;
    values[18][k] = square * m11;
    values[19][k] = square * m12;
    values[20][k] = square * m22;
    values[21][k] = y1 * b2 - y2 * b1;
    values[22][k] = y2 * b0 - y0 * b2;
    values[23][k] = y0 * b1 - y1 * b0;
    values[24][k] = rho * b0;
    values[25][k] = rho * b1;
    values[26][k] = rho * b2;
    if constexpr (Values == kOffsetValues) {
      const double ho = h0 * o0 + h1 * o1 + h2 * o2, kept = shrink * ho;
      const double c0 = w * (g00 * o0 + g10 * o1 - kept * q0);
      const double c1 = w * (g01 * o0 + g11 * o1 - kept * q1);
      const double c2 = w * (g02 * o0 + g12 * o1 + g22 * o2 - kept * q2);
      values[27][k] = y1 * c2 - y2 * c1;
      values[28][k] = y2 * c0 - y0 * c2;
      values[29][k] = y0 * c1 - y1 * c0;
      values[30][k] = rho * c0;
      values[31][k] = rho * c1;
      values[32][k] = rho * c2;
      values[33][k] = w * (o0 * o0 + o1 * o1 + o2 * o2 - kept * ho);
      values[34][k] = w * (o0 * e0 + o1 * e1 + o2 * e2 - kept * he);
    }
  }
}

template <std::size_t Values>
[[gnu::always_inline]] inline void sum_rows(const Columns& columns, double* depth, double* error, std::size_t begin,
                                            std::size_t end, const Shared& shared, double* sums) {
  double total[Values][kPlaceLanes] = {};
  for (std::size_t i = begin; i < end; i += kPlaceLanes) {
    Lanes<Values> lanes;
    evaluate_lanes(columns, depth + i, i, shared, lanes);
    for (std::size_t k = 0; k < kPlaceLanes; ++k) {
      depth[i + k] = lanes.depth[k];
      error[i + k] = lanes.error[k] < 0 ? error[i + k] : lanes.error[k];
    }
    for (std::size_t j = 0; j < Values; ++j)
      for (std::size_t k = 0; k < kPlaceLanes; ++k) total[j][k] += lanes.values[j][k];
  }
  for (std::size_t j = 0; j < Values; ++j) {
    sums[j] = 0;
    for (std::size_t k = 0; k < kPlaceLanes; ++k) sums[j] += total[j][k];
  }
}

QUADEDGE_VECTOR_CLONES
void sum_by_pose(const Columns& columns, double* depth, double* error, std::size_t begin, std::size_t end,
                 const Shared& shared, double* sums) {
  sum_rows<kPoseValues>(columns, depth, error, begin, end, shared, sums);
}

QUADEDGE_VECTOR_CLONES
void sum_by_pose_and_offset(const Columns& columns, double* depth, double* error, std::size_t begin, std::size_t end,
                            const Shared& shared, double* sums) {
  sum_rows<kOffsetValues>(columns, depth, error, begin, end, shared, sums);
}

QUADEDGE_VECTOR_CLONES
void evaluate_few(const Columns& columns, const double* depth, std::size_t first, const Shared& shared,
                  double (*values)[kPlaceLanes]) {
  Lanes<kPoseValues> lanes;
  evaluate_lanes(columns, depth + first, first, shared, lanes);
  for (std::size_t j = 0; j < kPoseValues; ++j)
    for (std::size_t k = 0; k < kPlaceLanes; ++k) values[j][k] = lanes.values[j][k];
}

template <std::size_t Values>
struct Sums {
  double values[Values] = {};
  Sums& operator+=(const Sums& other) {
    for (std::size_t j = 0; j < Values; ++j) values[j] += other.values[j];
    return *this;
  }
};

template <std::size_t Values>
Sums<Values> sum_all(PlaceTerms& terms, const Shared& shared, decltype(sum_by_pose)& sum_block) {
  const Columns columns(terms);
  return sum_row_blocks(terms.padded_size(), Sums<Values>(),
                        [&](std::size_t begin, std::size_t end, Sums<Values>& sum) {
                          sum_block(columns, terms.depth.data(), terms.error.data(), begin, end, shared, sum.values);
                        });
}

/// \param stride between consecutive values
template <int Size>
void unpack_pose(const double* values, std::size_t stride, Eigen::Matrix<double, Size, Size>& matrix) {
  for (int r = 0; r < 6; ++r) {
    for (int c = r; c < 6; ++c) {
      matrix(r, c) = matrix(c, r) = *values;
      values += stride;
    }
  }
}

}  // namespace

void PlaceTerms::assign(const QuadObservations& quads, const std::vector<std::int32_t>& rows, const PinholeCamera& left,
                        const NoiseModel& noise) {
  static_assert(kBlockRows % kPlaceLanes == 0);
  size_ = rows.size();
  const std::size_t padded = padded_size();
  for (auto& column : columns_)
    if (column.size() < padded) column.resize(padded);
  depth.assign(padded, 0.0);
  error.assign(padded, 0.0);
  for_row_blocks(padded, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      if (k >= size_) {
        for (auto& column : columns_) column[k] = 0;
        continue;
      }
      const FitTerm term = make_term(quads, static_cast<std::size_t>(rows[k]), noise);
      const double values[kColumns] = {term.ray.x(),
                                       term.ray.y(),
                                       term.inverse_depth,
                                       term.inverse_depth_sigma,
                                       term.inverse_depth_per_pixel,
                                       term.inverse_depth_bar_per_pixel,
                                       term.place.x(),
                                       term.place.y(),
                                       term.across.x() * left.fx,
                                       term.across.y() * left.fy,
                                       term.along.x() * left.fx,
                                       term.along.y() * left.fy,
                                       term.inverse_depth_bar,
                                       term.inverse_depth_bar_weight};
      for (int which = 0; which < kColumns; ++which) columns_[static_cast<std::size_t>(which)][k] = values[which];
    }
  });
}

Normal<6> normal_by_pose(PlaceTerms& terms, const Eigen::Isometry3d& current_from_previous, double offset,
                         const StudentWeights& weights) {
  const auto sums = sum_all<kPoseValues>(terms, Shared(current_from_previous, offset, weights), sum_by_pose);
  Normal<6> normal;
  unpack_pose(sums.values, 1, normal.matrix);
  normal.gradient = Eigen::Map<const Vector6d>(sums.values + 21);
  return normal;
}

Normal<7> normal_by_pose_and_offset(PlaceTerms& terms, const Eigen::Isometry3d& current_from_previous, double offset,
                                    const StudentWeights& weights) {
  const auto sums =
      sum_all<kOffsetValues>(terms, Shared(current_from_previous, offset, weights), sum_by_pose_and_offset);
  Normal<7> normal;
  unpack_pose(sums.values, 1, normal.matrix);
  normal.gradient.head<6>() = Eigen::Map<const Vector6d>(sums.values + 21);
  normal.matrix.topRightCorner<6, 1>() = Eigen::Map<const Vector6d>(sums.values + kPoseValues);
  normal.matrix.bottomLeftCorner<1, 6>() = normal.matrix.topRightCorner<6, 1>().transpose();
  normal.matrix(6, 6) = sums.values[33];
  normal.gradient(6) = sums.values[34];
  return normal;
}

Matrix6d PlaceContributions::matrix(std::size_t lane) const {
  Matrix6d result;
  unpack_pose(&values[0][lane], kPlaceLanes, result);
  return result;
}

Vector6d PlaceContributions::gradient(std::size_t lane) const {
  Vector6d result;
  for (int r = 0; r < 6; ++r) result(r) = values[21 + r][lane];
  return result;
}

void contributions_by_pose(const PlaceTerms& terms, const Eigen::Isometry3d& current_from_previous, double offset,
                           const StudentWeights& weights, std::size_t first, PlaceContributions& result) {
  evaluate_few(Columns(terms), terms.depth.data(), first, Shared(current_from_previous, offset, weights),
               result.values);
}

}  // namespace quadedge::pose
