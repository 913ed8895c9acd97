#pragma once
/// \file device_frontend.hpp  The front end on an OpenCL device.

#include "frontend/coarse_gate.hpp"
#include "frontend/frontend.hpp"
#include "frontend/range_follower.hpp"
#include "stages/candidate_filters.hpp"
#include "stages/coarse_disparity.hpp"
#include "stages/edge_detection.hpp"
#include "stages/edge_mask.hpp"
#include "stages/edge_selection.hpp"
#include "stages/edge_threshold.hpp"
#include "stages/patches.hpp"
#include "stages/sift.hpp"
#include "stages/stereo_candidates.hpp"
#include "stages/stereo_clusters.hpp"
#include "stages/stereo_mutual.hpp"
#include "stages/stereo_refinement.hpp"
#include "stages/stereo_relaxation.hpp"
#include "stages/temporal_candidates.hpp"
#include "stages/temporal_match.hpp"
#include "stages/temporal_quads.hpp"
#include "stages/undistortion.hpp"
#include "stages/wide_description.hpp"
#include "stages/wide_matching.hpp"

namespace quadedge::frontend {

/// A rig with its buffers on the device.
struct DeviceRig : Rig {
  explicit DeviceRig(const StereoRig& calibration);
  stages::DeviceStereoEdges on_device;
  opencl::Buffer<cl_uchar> wide;  ///< wide descriptors of all edges, only of a restored rig
  bool is_restored = false;
};

/// Owns all stages and the rigs.
class DeviceFrontend : public Frontend {
 public:
  DeviceFrontend(const StereoRig& rig, opencl::Context& context, const Config& config);

  RigHandle process(const StereoFrame& frame) override;
  void match(const Rig& base, const TemporalSearch& search, TemporalMatches& matches) override;
  void match_globally(const Rig& base, int edges, TemporalMatches& matches) override;
  void match_globally(const Rig& base, const GlobalSearch& among, TemporalMatches& matches) override;
  KeptRig keep() override;
  RigHandle restore(const KeptRig& kept) override;
  EdgeSet edges(Side side) override;
  std::size_t device_bytes() const override { return context_.bytes(); }

 private:
  /// Stages 1 to 3 of one camera.
  struct Camera {
    stages::Undistortion undistortion;
    stages::PaddedPlane plane;
    stages::EdgeDetection detection;
    stages::EdgeMask mask;
    stages::Patches patches;
    stages::Sift sift;
    stages::DeviceEdges edges;
    Camera(opencl::Context& context, const PinholeCamera& camera, const UndistortionTable& table,
           const PixelMask& hidden, int max_value, const Config& config);
  };

  /// Detects the edges of both images and waits for their number.
  void detect(DeviceRig& current);
  /// Stages 4 and 5, within the current disparity range. \returns false if the frame is to be searched again
  bool find_stereo_edges(DeviceRig& current);
  /// The coarse disparity of the frame; null where the gate is shut or the rig is not rectified.
  const stages::CoarseDisparity* witness(const stages::DeviceStereoEdges& rig);
  /// Indexes the current stereo edges of both images, once per frame.
  void index_current();
  /// About `wanted` stereo edges of the current rig with their wide descriptors, which are computed once per frame and
  /// number.
  stages::DeviceWideEdges describe_current(int wanted);
  const stages::DevicePointIndex& index(Side side) const { return side == Side::left ? left_index_ : right_index_; }
  stages::DescribedEdges described(const stages::DeviceStereoEdges& rig, Side side) const;
  /// Computes SIFT descriptors of a rig's stereo edges, unless they exist.
  void describe_by_sift(DeviceRig& rig);
  /// Runs the search in one kernel. \returns false, with undefined `matches`, if there are too many candidates for it
  bool match_fused(DeviceRig& base, const TemporalSearch& search, TemporalMatches& matches);
  /// Runs the search with candidate lists: for searches with SIFT, for too many candidates, and for the corresponding
  /// variant.
  void match_by_lists(DeviceRig& base, const TemporalSearch& search, TemporalMatches& matches);
  void match_side(Side side, DeviceRig& base, const TemporalSearch& search, stages::DeviceCandidates& candidates);
  void tap_stereo();
  void tap_candidates_without_limits();
  void tap_search(const Rig& base, const TemporalSearch& search);
  void tap_temporal(const TemporalSearch& search);

  opencl::Context& context_;
  Config config_;
  RangeFollower range_;
  CoarseGate gate_;
  Camera left_, right_;
  stages::EdgeThreshold threshold_;
  stages::EdgeSelection selection_;
  stages::StereoCandidates stereo_candidates_;
  stages::CandidateFilters filters_;
  stages::StereoRefinement refinement_;
  stages::StereoClusters clustering_;
  stages::CoarseDisparity coarse_;
  stages::StereoRelaxation relaxation_;
  stages::StereoMutual mutual_;
  stages::PointIndex point_index_;
  stages::TemporalCandidates temporal_candidates_;
  stages::TemporalQuads temporal_quads_;
  stages::TemporalMatch temporal_match_;
  stages::WideDescription wide_description_;
  stages::WideMatching wide_matching_;

  stages::DeviceCandidates candidates_, temporal_left_, temporal_right_;
  opencl::Buffer<cl_float> small_;  ///< reduced image for match_globally(), as are these descriptors
  opencl::Buffer<cl_uchar> wide_before_, wide_now_, wide_some_;
  stages::DeviceStereoEdges some_before_, some_now_;  ///< edges given to match_globally(): left positions, directions
  stages::DeviceRefined refined_;
  stages::DeviceClusters clusters_;
  stages::DeviceRelaxation relaxed_;
  stages::DeviceMutual owners_;
  stages::DevicePositions predicted_;  ///< lists: left, right
  stages::DevicePointIndex left_index_, right_index_;
  bool indexed_ = false;                   ///< for the current frame
  int wide_rows_ = -1, wide_step_ = 1;     ///< of wide_now_; -1: not yet described
  opencl::Buffer<cl_char> right_patches_;  ///< of the right edges that are candidates
  opencl::Buffer<cl_uchar> left_sift_{context_, 0},
      right_sift_{context_, 0};    ///< of all edges, if the stereo cascade uses SIFT
  opencl::Buffer<cl_int> itself_;  ///< the identity permutation 0, 1, 2 ...
  RigPool<DeviceRig> rigs_;
};

}  // namespace quadedge::frontend
