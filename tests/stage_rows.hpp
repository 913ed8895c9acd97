#pragma once
/// \file stage_rows.hpp  The harness of the tests of stages: every variant on every device, twice, beside the plain
/// C++.

#include "testing.hpp"

/// How far a stage's values may lie from those of the plain C++; by default they are equal.
struct Within {
  double margin = 0;         ///< of a value
  std::size_t outliers = 0;  ///< values beyond it
  double period = 0;         ///< of angles
};

/// One array that a stage has found.
class StageArray {
 public:
  /// Compared between runs and variants only.
  template <class T>
  StageArray(std::string name, const std::vector<T>& found) : name_(std::move(name)), bytes_(found.size() * sizeof(T)) {
    if (!found.empty()) std::memcpy(bytes_.data(), found.data(), bytes_.size());
  }
  /// Compared with the plain C++'s, too.
  template <class T, class U>
  StageArray(std::string name, const std::vector<T>& found, const std::vector<U>& truth, const Within& within = {})
      : StageArray(std::move(name), found) {
    has_size_ = found.size() == truth.size();
    outliers_ = within.outliers;
    for (std::size_t i = 0; has_size_ && i < found.size(); ++i) {
      double apart = static_cast<double>(found[i]) - static_cast<double>(truth[i]);
      if (within.period > 0) apart = std::remainder(apart, within.period);
      beyond_ += std::abs(apart) <= within.margin ? 0 : 1;
    }
  }

  /// Checks this array, and that another run and another variant have found the same bytes.
  void check(const StageArray& again, const StageArray& other) const {
    INFO(name_);
    CHECK(has_size_);
    CHECK(beyond_ <= outliers_);
    const bool is_reproduced = bytes_ == again.bytes_, is_that_of_other_variants = bytes_ == other.bytes_;
    CHECK(is_reproduced);
    CHECK(is_that_of_other_variants);
  }

 private:
  std::string name_;
  std::vector<unsigned char> bytes_;
  bool has_size_ = true;
  std::size_t beyond_ = 0, outliers_ = 0;
};
using StageArrays = std::vector<StageArray>;

/// Runs a row of a stage's test on every device with every variant: `run` uploads its input, runs the stage and returns
/// what it found beside the plain C++'s, or nothing if the variant has no kernel for it. Two runs, and all variants of
/// a device, give the same bytes, and every kernel has the signature that the host expects.
inline void check_stage(
    const std::string& stage,
    const std::function<StageArrays(quadedge::opencl::Context& context, const Variants& variants)>& run) {
  for (const auto& index : all_devices()) {
    quadedge::Device device(index, kept_programs());
    auto& context = *device.context();
    const bool is_simulated = Catch::contains(device.info().name, "Oclgrind");  // work-item by work-item: reproducible
    StageArrays first;
    for (const auto& variant : quadedge::opencl::all_variants()) {
      if (variant.stage != stage) continue;
      INFO(device.info().name << " " << variant.name);
      context.check_kernels(true);
      const StageArrays found = run(context, {{stage, variant.name}}),
                        again = is_simulated ? found : run(context, {{stage, variant.name}});
      context.check_kernels(false);
      CHECK(context.kernel_faults().empty());
      if (found.empty()) continue;
      if (first.empty()) first = found;
      REQUIRE((found.size() == again.size() && found.size() == first.size()));
      for (std::size_t k = 0; k < found.size(); ++k) found[k].check(again[k], first[k]);
    }
    CHECK_FALSE(first.empty());
  }
}

/// All arrays of matches beside those of the plain C++, which they equal.
inline StageArrays arrays_of(const quadedge::TemporalMatches& found, const quadedge::TemporalMatches& truth) {
  return {{"previous", found.previous, truth.previous},
          {"current", found.current, truth.current},
          {"competing clusters", found.competing_clusters, truth.competing_clusters},
          {"ncc", found.ncc, truth.ncc},
          {"left x", found.left_x, truth.left_x},
          {"left y", found.left_y, truth.left_y},
          {"left direction", found.left_direction, truth.left_direction},
          {"right x", found.right_x, truth.right_x},
          {"right y", found.right_y, truth.right_y},
          {"right direction", found.right_direction, truth.right_direction}};
}

/// All arrays of edges, compared between runs and variants.
inline StageArrays arrays_of(const quadedge::EdgeSet& edges) {
  return {{"x", edges.x},
          {"y", edges.y},
          {"direction", edges.direction},
          {"strength", edges.strength},
          {"scale shift", edges.scale_shift},
          {"row first", edges.row_first}};
}
