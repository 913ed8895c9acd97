/// \file evaluation.cpp  Errors against ground truth (include/quadedge/evaluation.hpp).

#include "quadedge/evaluation.hpp"

#include <nanobind/stl/vector.h>

#include "arguments.hpp"
#include "arrays.hpp"

namespace quadedge::python {
namespace {

using PerPose = TrajectoryEvaluation::PerPose;

/// (N,) over one column of the rows.
template <class T>
auto column(T PerPose::*field) {
  return [field](const TrajectoryEvaluation& self) { return view_of(self.per_pose, field); };
}

}  // namespace

void bind_evaluation(nb::module_& module) {
  nb::class_<ErrorStatistics>(module, "ErrorStatistics",
                              "Statistics of one kind of error, in the unit that its attribute names.")
      .def_ro("mean", &ErrorStatistics::mean)
      .def_ro("std", &ErrorStatistics::std, "Standard deviation, with divisor N.")
      .def_ro("rmse", &ErrorStatistics::rmse)
      .def_ro("max", &ErrorStatistics::max);
  nb::class_<PoseErrors>(module, "PoseErrors",
                         "Absolute (APE) and relative (RPE) pose errors: rotation [deg], translation [m].")
      .def_ro("ape_rotation_deg", &PoseErrors::ape_rotation_deg)
      .def_ro("ape_translation_m", &PoseErrors::ape_translation_m)
      .def_ro("rpe_rotation_deg", &PoseErrors::rpe_rotation_deg,
              "Between consecutive matched poses of one segment [deg].")
      .def_ro("rpe_translation_m", &PoseErrors::rpe_translation_m);
  nb::class_<SubPathErrors>(module, "SubPathErrors",
                            "Relative errors over sub-paths of one length, or of all, as KITTI's odometry benchmark\n"
                            "defines them: from every tenth pose to the first one that is farther along the true path.")
      .def_ro("length_m", &SubPathErrors::length_m, "Length [m]; NaN: all lengths.")
      .def_ro("count", &SubPathErrors::count, "Number of sub-paths.")
      .def_ro("translation_percent", &SubPathErrors::translation_percent, "Mean t_rel [%]; NaN without sub-paths.")
      .def_ro("rotation_deg_per_m", &SubPathErrors::rotation_deg_per_m, "Mean r_rel [deg/m]; NaN without sub-paths.")
      .def_ro("translation_sd_percent", &SubPathErrors::translation_sd_percent, "Standard deviation of t_rel [%].")
      .def_ro("rotation_sd_deg_per_m", &SubPathErrors::rotation_sd_deg_per_m, "Standard deviation of r_rel [deg/m].");
  using Self = TrajectoryEvaluation;
  nb::class_<Self>(module, "TrajectoryEvaluation", "Errors of a trajectory. Arrays have one row per matched pose.")
      .def_ro("origin_aligned", &Self::origin_aligned, "Errors after aligning the first matched poses.")
      .def_ro("se3_aligned", &Self::se3_aligned,
              "Errors after the least-squares rigid alignment (Umeyama without scale).")
      .def_ro("matched", &Self::matched, "Number of matched poses.")
      .def_ro("segment", &Self::segment, "Number of the first pose's segment.")
      .def_ro("segments", &Self::segments,
              "If poses of several segments match: a TrajectoryEvaluation of each by itself, with its own alignments;\n"
              "otherwise empty. Errors of a segment with a single pose are NaN.")
      .def_ro("sub_paths", &Self::sub_paths, "SubPathErrors of every length.")
      .def_ro("sub_path_mean", &Self::sub_path_mean, "SubPathErrors over the sub-paths of all lengths.")
      .def_ro("rpe_interval_s", &Self::rpe_interval_s, "Median duration of the steps of RPE [s].")
      .def_ro("path_length_m", &Self::path_length_m, "Length of the matched ground truth [m].")
      .def_ro("end_drift_percent", &Self::end_drift_percent,
              "Error of the last position relative to the path length [%]; NaN where the truth does not move.")
      .def_prop_ro("stamps_ns", column(&PerPose::stamp_ns), kView, "(N,) int64 [ns].")
      .def_prop_ro("ape_rotation_deg", column(&PerPose::ape_rotation_deg), kView, "(N,): origin-aligned.")
      .def_prop_ro("ape_translation_m", column(&PerPose::ape_translation_m), kView, "(N,): origin-aligned.")
      .def_prop_ro("rpe_rotation_deg", column(&PerPose::rpe_rotation_deg), kView,
                   "(N,): NaN for the first pose of a segment.")
      .def_prop_ro("rpe_translation_m", column(&PerPose::rpe_translation_m), kView,
                   "(N,): NaN for the first pose of a segment.");
  module.def(
      "evaluate_trajectory", &evaluate_trajectory, "estimate"_a, "truth"_a, "from_frame"_a = 0,
      "max_stamp_difference_ns"_a = kStampToleranceNs, "lengths"_a = kKittiLengths,
      "Compares an estimated Trajectory with the ground truth. Every pose is matched at most once, with the nearest "
      "time\n"
      "stamp. The errors of the whole include the unknown motions between segments, except for RPE, which is not\n"
      "computed across them.\n\n"
      "from_frame: number of leading poses of the estimate to skip.\n"
      "max_stamp_difference_ns: largest difference of matched time stamps [ns]; use 0 where stamps are row numbers\n"
      "(KITTI files).\n"
      "lengths: of the sub-paths of t_rel and r_rel [m].\n\n"
      "Raises DataError if fewer than two poses match.");
}

}  // namespace quadedge::python
