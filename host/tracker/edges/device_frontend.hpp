#pragma once
/// \file device_frontend.hpp  The front end on an OpenCL device.

#include "device/candidates.hpp"
#include "device/edge_descriptions.hpp"
#include "device/edge_detection.hpp"
#include "device/images.hpp"
#include "device/stereo_matching.hpp"
#include "device/temporal_matching.hpp"
#include "edges/frontend.hpp"
#include "edges/noise_gate.hpp"
#include "edges/range_follower.hpp"
#include "edges/staged_frontend.hpp"

namespace quadedge::frontend {

/// The edges of a frame with their buffers on the device.
struct DeviceFrameEdges : FrameEdges {
  explicit DeviceFrameEdges(const StereoRig& calibration);
  stages::DeviceStereoEdges on_device;
  opencl::Buffer<cl_uchar> wide;  ///< wide descriptors of all edges, only of a restored frame
};

/// Owns all stages and the edges of frames.
class DeviceFrontend : public StagedFrontend {
 public:
  DeviceFrontend(const StereoRig& rig, opencl::Context& context, const Config& config);

  FrameEdgesHandle process(const StereoFrame& frame) override;
  FrameEdgesHandle latest() const override { return frames_.current_handle(); }
  KeptFrameEdges keep() override;
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

  void masks_changed() override {
    left_.mask.set(masks_.left, config_.edges.margin);
    right_.mask.set(masks_.right, config_.edges.margin);
  }
  FrameEdges& start(const StereoFrame& frame) override;
  /// Prepares both images for detection and measures their threshold.
  void measure(const stages::DeviceStereoEdges& stereo_edges, stages::EdgeThreshold& threshold, float known_noise);
  /// Smooths both images and measures them again, if their noise asks for it and they are not smoothed yet.
  /// \returns whether it did, so that edges are to be found again
  bool smooth_if_noisy(FrameEdges& current);
  void find_edges();
  void detect(FrameEdges& current) override;
  void describe(const FrameEdges& current, bool by_sift) override;
  RelaxationTally find_stereo_edges(FrameEdges& current, const EpipolarGeometry& geometry, const DisparityProbe& probe,
                                    const std::optional<CoarseDisparityArguments>& coarse) override;
  void finish(FrameEdges& current) override;
  void tap_stereo() override;
  void describe_by_sift(FrameEdges& frame_edges) override;
  void search_in_time(FrameEdges& base, FrameEdges& current, const TemporalSearch& search,
                      TemporalMatches& matches) override;
  TemporalMatches search_globally(const FrameEdges& base, const WideSubset& of_base, const FrameEdges& current,
                                  const WideSubset& of_current) override;
  std::shared_ptr<FrameEdges> spare() override { return frames_.restored(calibration_); }
  void load(const KeptFrameEdges& kept, FrameEdges& restored) override;
  DeviceFrameEdges& own(const FrameEdges& frame_edges) override { return frames_.own(frame_edges); }

  /// One side of a global search.
  struct WideSide {
    opencl::Buffer<cl_uchar> descriptors;
    int rows = 0;
    stages::DeviceStereoEdges given;  ///< left positions and directions of edges that are not every step-th of a frame
    std::vector<cl_float> packed;     ///< the same on the host
  };

  /// The coarse disparity of the images; null where no search is given or memory does not suffice.
  const stages::CoarseDisparity* coarse_disparity(const stages::DeviceStereoEdges& stereo_edges,
                                                  const std::optional<CoarseDisparityArguments>& search);
  /// Indexes the stereo edges of both images, once in a row for the same frame.
  void index_current(const DeviceFrameEdges& current);
  /// Wide descriptors of a subset of a frame's edges; given ones are copied to the device from `packed`, which must
  /// outlive the copy.
  stages::DeviceWideEdges describe_widely(const DeviceFrameEdges& frame_edges, const WideSubset& subset,
                                          WideSide& side);
  const stages::DevicePointIndex& index(Side side) const { return side == Side::left ? left_index_ : right_index_; }
  stages::DescribedEdges described(const stages::DeviceStereoEdges& stereo_edges, Side side) const;
  /// Runs the search with candidate lists: for searches with SIFT, for too many candidates, for taps, and for the
  /// corresponding variant.
  void match_by_lists(const DeviceFrameEdges& base, const DeviceFrameEdges& current, const TemporalSearch& search,
                      TemporalMatches& matches);
  void match_side(Side side, const DeviceFrameEdges& base, const DeviceFrameEdges& current,
                  const TemporalSearch& search, stages::DeviceCandidates& candidates);
  void tap_temporal(const TemporalSearch& search);

  opencl::Context& context_;
  Camera left_, right_;
  stages::EdgeThreshold threshold_, smoothed_threshold_;
  stages::EdgeThreshold* used_threshold_ = &threshold_;
  stages::Smoothing smoothing_;
  NoiseGate noise_gate_;
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
  stages::GlobalMatching global_matching_;

  stages::DeviceCandidates candidates_, temporal_left_, temporal_right_;
  opencl::Buffer<cl_float> small_;  ///< reduced image for global searches
  WideSide wide_before_, wide_now_, wide_some_;
  stages::DeviceRefined refined_;
  stages::DeviceClusters clusters_;
  stages::DeviceRelaxation relaxed_;
  stages::DevicePositions predicted_;  ///< lists: left, right
  stages::DevicePointIndex left_index_, right_index_;
  const FrameEdges* indexed_ = nullptr;    ///< the frame of both indices; null: none
  const FrameEdges* described_ = nullptr;  ///< the frame of wide_now_; null: none
  int global_step_ = 0;                    ///< of its edges there
  opencl::Buffer<cl_char> right_patches_;  ///< of the right edges that are candidates
  opencl::Buffer<cl_uchar> left_sift_{context_, 0},
      right_sift_{context_, 0};    ///< of all edges, if the stereo cascade uses SIFT
  opencl::Buffer<cl_int> itself_;  ///< the identity permutation 0, 1, 2 ...
  FrameEdgesPool<DeviceFrameEdges> frames_;
};

}  // namespace quadedge::frontend
