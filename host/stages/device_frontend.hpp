#pragma once
/// \file device_frontend.hpp  The frontend on an OpenCL device.

#include "stages/candidate_filters.hpp"
#include "stages/edge_description.hpp"
#include "stages/edge_detection.hpp"
#include "stages/epipolar_geometry.hpp"
#include "stages/frontend.hpp"
#include "stages/stereo_candidates.hpp"
#include "stages/stereo_clusters.hpp"
#include "stages/stereo_refinement.hpp"
#include "stages/temporal_candidates.hpp"
#include "stages/temporal_quads.hpp"
#include "stages/undistortion.hpp"

namespace quadedge::stages {

/// Owns every stage and the memory of three rigs.
class DeviceFrontend : public Frontend {
 public:
  DeviceFrontend(const StereoRig& rig, opencl::Context& context, const Config& config);

  void process(const StereoFrame& frame) override;
  void keep(bool as_key) override;
  TemporalMatches match(Base base, const TemporalSearch& search) override;
  EdgeSet edges(bool right) override;
  std::size_t device_bytes() const override { return context_.bytes(); }

 private:
  /// Stages 1 to 3 of one camera.
  struct Camera {
    Undistortion undistortion;
    EdgeDetection detection;
    EdgeDescription description;
    DeviceEdges edges;
    DeviceDescriptions descriptions;
    Camera(opencl::Context& context, const PinholeCamera& camera, const UndistortionTable& table, const Config& config);
  };

  void match_side(int side, Base base, const TemporalSearch& search, DeviceCandidates& candidates);
  void tap_stereo();
  void tap_candidates_without_limits();
  void tap_temporal(int side, const TemporalSearch& search);

  opencl::Context& context_;
  Config config_;
  EpipolarGeometry epipolar_;
  opencl::Buffer<cl_float> geometry_;
  int left_height_, right_height_;
  Camera left_, right_;
  StereoCandidates stereo_candidates_;
  CandidateFilters filters_;
  StereoRefinement refinement_;
  StereoClusters clustering_;
  TemporalCandidates temporal_candidates_;
  TemporalQuads temporal_quads_;

  DeviceCandidates candidates_, temporal_left_, temporal_right_;
  DeviceRefined refined_;
  DeviceClusters clusters_;
  DevicePlaces predicted_[2];  ///< left, right
  DevicePointIndex left_index_, right_index_;
  DeviceImage left_image_, right_image_;
  DeviceStereoEdges rigs_[3];
  int now_ = 0, previous_rig_ = 1, key_rig_ = 1;  ///< places in rigs_
};

}  // namespace quadedge::stages
