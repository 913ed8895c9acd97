#pragma once
/// \file plain_vector.hpp  Scalar 3-vectors. Loops over quads that use them are vectorised across quads, which Eigen's
/// fixed-size vectors prevent. All sums are evaluated from the first to the last term.

namespace quadedge::pose {

struct Vector3 {
  double x, y, z;
};

[[gnu::always_inline]] inline double dot(const Vector3& a, const Vector3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

[[gnu::always_inline]] inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

[[gnu::always_inline]] inline Vector3 operator*(double factor, const Vector3& a) {
  return {factor * a.x, factor * a.y, factor * a.z};
}

/// A symmetric 3 x 3 matrix, stored as its upper triangle.
struct Symmetric3 {
  double xx, xy, xz, yy, yz, zz;
  [[gnu::always_inline]] Vector3 column_x() const { return {xx, xy, xz}; }
  [[gnu::always_inline]] Vector3 column_y() const { return {xy, yy, yz}; }
  [[gnu::always_inline]] Vector3 column_z() const { return {xz, yz, zz}; }
};

[[gnu::always_inline]] inline Symmetric3 operator*(double factor, const Symmetric3& a) {
  return {factor * a.xx, factor * a.xy, factor * a.xz, factor * a.yy, factor * a.yz, factor * a.zz};
}

}  // namespace quadedge::pose
