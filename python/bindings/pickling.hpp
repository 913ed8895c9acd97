#pragma once
/// \file pickling.hpp  Pickling (and so copying) of structures, from one list of their members each.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/error.hpp"
#include "quadedge/odometry.hpp"

namespace quadedge::python {

constexpr const char* kOtherVersion = "pickle: found a structure of another version of quadedge, expected this one";

// The members of a structure, in a fixed order.
inline auto members(PinholeCamera& self) {
  return std::tie(self.fx, self.fy, self.cx, self.cy, self.width, self.height);
}
inline auto members(UndistortionTable& self) {
  return std::tie(self.width, self.height, self.source_x, self.source_y, self.recorded_width, self.recorded_height);
}
inline auto members(PixelMask& self) { return std::tie(self.width, self.height, self.hidden); }
inline auto members(StereoRig& self) {
  return std::tie(self.left, self.right, self.right_from_left.matrix(), self.left_undistortion, self.right_undistortion,
                  self.left_mask, self.right_mask, self.max_value, self.max_disparity);
}
inline auto members(FrameCounts& self) {
  return std::tie(self.edges_left, self.edges_right, self.stereo_edges, self.temporal_left, self.temporal_right,
                  self.quads, self.inliers);
}
inline auto members(RigEvidence& self) {
  return std::tie(self.matched_ratio, self.epipolar_residual, self.epipolar_correction, self.found_ratio,
                  self.searched_residual, self.on_line_ratio, self.negative_ratio, self.beyond_ratio);
}
inline auto members(StageTime& self) { return std::tie(self.stage, self.ms); }
inline auto members(Eigen::Isometry3d& self) { return std::tie(self.matrix()); }
inline auto members(Warning& self) { return std::tie(self.kind, self.text); }
inline auto members(FrameTiming& self) { return std::tie(self.stages, self.kernels, self.latency_ms); }
inline auto members(FrameDiagnostics& self) {
  return std::tie(self.edge_threshold, self.disparity_range, self.overflow, self.base_frame, self.search,
                  self.moving_ratio, self.moving_cells, self.moving_box, self.rig_evidence,
                  self.covariance_in_reference, self.rig_sensitivity);
}
inline auto members(RectificationError& self) {
  return std::tie(self.offset, self.slope_x, self.slope_y, self.bend_xx, self.bend_xy, self.bend_yy);
}
inline auto members(RigEstimate& self) {
  return std::tie(self.rows, self.disparity_offset, self.disparity_offset_sigma, self.disparity_offset_shared,
                  self.displacement, self.displacement_sigma, self.disparity_error, self.disparity_error_weight);
}
inline auto members(FrameResult& self) {
  return std::tie(self.stamp_ns, self.status, self.segment, self.world_from_left, self.predicted_world_from_left,
                  self.covariance, self.current_from_reference, self.relative_covariance, self.reference_frame,
                  self.new_key_rig, self.rig, self.ambiguous_motion, self.counts, self.message, self.warnings,
                  self.timing, self.diagnostics);
}

template <class T>
nb::bytes pack_array(const T* values, std::size_t count) {
  return nb::bytes(reinterpret_cast<const char*>(values), count * sizeof(T));
}

/// \throws DataError for an array of another length.
template <class T>
void unpack_array(nb::handle packed, T* values, std::size_t count) {
  const auto bytes = nb::cast<nb::bytes>(packed);
  if (bytes.size() != count * sizeof(T)) throw DataError(kOtherVersion);
  const auto* first = static_cast<const T*>(bytes.data());
  std::copy(first, first + count, values);
}

template <class T, class = void>
struct Packed {  // a structure: a tuple of its packed members
  static nb::object pack(const T& value) {
    return std::apply(
        [](auto&... member) {
          return nb::make_tuple(Packed<std::remove_reference_t<decltype(member)>>::pack(member)...);
        },
        members(const_cast<T&>(value)));  // which are only read
  }
  static void unpack(nb::handle packed, T& value) {
    const auto all = members(value);
    const auto state = nb::cast<nb::tuple>(packed);
    constexpr std::size_t kCount = std::tuple_size_v<std::remove_const_t<decltype(all)>>;
    if (state.size() != kCount) throw DataError(kOtherVersion);
    std::size_t next = 0;
    std::apply(
        [&](auto&... member) {
          (Packed<std::remove_reference_t<decltype(member)>>::unpack(state[next++], member), ...);
        },
        all);
  }
};
template <class T>
struct Packed<T, std::enable_if_t<std::is_arithmetic_v<T>>> {
  static nb::object pack(T value) { return nb::cast(value); }
  static void unpack(nb::handle packed, T& value) { value = nb::cast<T>(packed); }
};
template <class T>
struct Packed<T, std::enable_if_t<std::is_enum_v<T>>> {
  static nb::object pack(T value) { return nb::cast(static_cast<int>(value)); }
  static void unpack(nb::handle packed, T& value) { value = static_cast<T>(nb::cast<int>(packed)); }
};
template <>
struct Packed<std::string> {
  static nb::object pack(const std::string& value) { return nb::str(value.c_str(), value.size()); }
  static void unpack(nb::handle packed, std::string& value) { value = nb::cast<nb::str>(packed).c_str(); }
};
template <class T, int Rows, int Columns, int Options>
struct Packed<Eigen::Matrix<T, Rows, Columns, Options>> {
  using Matrix = Eigen::Matrix<T, Rows, Columns, Options>;
  static nb::object pack(const Matrix& value) { return pack_array(value.data(), Rows * Columns); }
  static void unpack(nb::handle packed, Matrix& value) { unpack_array(packed, value.data(), Rows * Columns); }
};
template <class T>
struct Packed<std::optional<T>> {
  static nb::object pack(const std::optional<T>& value) { return value ? Packed<T>::pack(*value) : nb::none(); }
  static void unpack(nb::handle packed, std::optional<T>& value) {
    value.reset();
    if (!packed.is_none()) Packed<T>::unpack(packed, value.emplace());
  }
};
template <class T>
struct Packed<std::vector<T>, std::enable_if_t<std::is_arithmetic_v<T>>> {
  static nb::object pack(const std::vector<T>& values) { return pack_array(values.data(), values.size()); }
  static void unpack(nb::handle packed, std::vector<T>& values) {
    values.resize(nb::cast<nb::bytes>(packed).size() / sizeof(T));
    unpack_array(packed, values.data(), values.size());
  }
};
template <>
struct Packed<SharedFloats> {
  static nb::object pack(const SharedFloats& shared) { return Packed<std::vector<float>>::pack(shared.values()); }
  static void unpack(nb::handle packed, SharedFloats& shared) {
    Packed<std::vector<float>>::unpack(packed, shared.change());
  }
};
template <class T>
struct Packed<std::vector<T>, std::enable_if_t<std::is_class_v<T>>> {
  static nb::object pack(const std::vector<T>& values) {
    nb::list list;
    for (const T& value : values) list.append(Packed<T>::pack(value));
    return list;
  }
  static void unpack(nb::handle packed, std::vector<T>& values) {
    values.clear();
    for (const nb::handle value : nb::cast<nb::list>(packed)) Packed<T>::unpack(value, values.emplace_back());
  }
};

/// Lets Python pickle and copy the class.
template <class T>
void add_pickling(nb::class_<T>& bound) {
  bound.def("__getstate__", [](const T& self) { return Packed<T>::pack(self); })
      .def(
          "__setstate__",
          [](T& self, nb::handle state) {
            T unpacked;
            try {
              Packed<T>::unpack(state, unpacked);
            } catch (const nb::cast_error&) {
              throw DataError("pickle: found members of other types, expected one by this version of quadedge");
            }
            new (&self) T(std::move(unpacked));
          },
          nb::arg("state").none());
}

}  // namespace quadedge::python
