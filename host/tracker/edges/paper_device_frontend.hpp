#pragma once
/// \file paper_device_frontend.hpp  The front end of the paper's method on an OpenCL device.

#include "device/candidates.hpp"
#include "device/edge_descriptions.hpp"
#include "device/edge_detection.hpp"
#include "device/grid_edges.hpp"
#include "device/images.hpp"
#include "device/paper_matching.hpp"
#include "device/stereo_matching.hpp"
#include "device/temporal_matching.hpp"
#include "edges/paper_frontend.hpp"

namespace quadedge::frontend {

/// The stereo edges of a frame as one of its cameras sees them, on the device.
struct PaperSide {
  stages::DevicePicture picture;
  opencl::Buffer<cl_float> patches;
  opencl::Buffer<cl_uchar> sift;
  opencl::Buffer<cl_int> number;  ///< of each stereo edge's patches and descriptor
};

/// The edges of a frame with what a later frame compares of them.
struct PaperDeviceFrameEdges : FrameEdges {
  explicit PaperDeviceFrameEdges(const StereoRig& calibration);
  PaperSide left, right;
  stages::DevicePositions positions;  ///< lists: left, right

  PaperSide& side(Side which) { return which == Side::left ? left : right; }
};

/// Lists of candidates are read by the host only for a tap.
class PaperDeviceFrontend : public PaperFrontend {
 public:
  PaperDeviceFrontend(const StereoRig& rig, opencl::Context& context, const Config& config);

  FrameEdgesHandle process(const StereoFrame& frame) override;
  FrameEdgesHandle latest() const override { return frames_.current_handle(); }
  EdgeSet edges(Side side) override;
  std::size_t device_bytes() const override { return context_.bytes(); }

 private:
  /// Edges and their descriptions of one camera.
  struct Camera {
    stages::Undistortion undistortion;
    stages::PaddedPlane plane;
    stages::GridEdges detection;
    stages::PaperPatches patches;
    stages::Sift sift;
    opencl::Buffer<cl_uchar> image;
    stages::DeviceEdges edges;
    opencl::Buffer<cl_float> patches_of_edges;
    opencl::Buffer<cl_uchar> sift_of_edges;
    Camera(opencl::Context& context, const PinholeCamera& camera, const UndistortionTable& table,
           const PixelMask& hidden, int max_value, const Config& config);
    void describe(double offset);
  };
  /// The cascade in time in one image.
  struct TimeSide {
    stages::DeviceCandidates candidates;
    opencl::Buffer<cl_float> refined;
    stages::DevicePaperClusters clusters;
  };

  void masks_changed() override;
  FrameEdges& detect(const StereoFrame& frame) override;
  void find_stereo_edges(FrameEdges& current, paper::StereoMatching* all) override;
  void collect_stereo_edges(const stages::DevicePaperClusters::Lists& clusters, StereoEdges& edges);
  void keep_descriptions(PaperDeviceFrameEdges& now);
  void find_quads(const FrameEdges& base, const FrameEdges& current, std::array<paper::SideMatching, 2>* all,
                  TemporalMatches& matches) override;
  CandidateLists near_lines(const EpipolarGeometry& geometry) override;
  CandidateLists near_previous(const FrameEdges& before, const FrameEdges& now, Side side) override;
  void match_side(PaperDeviceFrameEdges& before, PaperDeviceFrameEdges& now, Side side, bool all_scores,
                  TimeSide& found);

  opencl::Context& context_;
  Camera left_, right_;
  stages::EdgeThreshold threshold_;
  stages::StereoCandidates stereo_candidates_;
  stages::PaperFilters filters_;
  stages::PaperRefinement refinement_;
  stages::PaperClusters clustering_;
  stages::PointIndex point_index_;
  stages::TemporalCandidates temporal_candidates_;
  stages::PaperQuads quads_;

  stages::DeviceCandidates candidates_;
  opencl::Buffer<cl_float> refined_;
  stages::DevicePaperClusters clusters_;
  std::array<TimeSide, 2> in_time_;
  stages::DevicePointIndex left_index_, right_index_;
  opencl::Buffer<cl_int> itself_;  ///< the identity permutation 0, 1, 2 ...
  FrameEdgesPool<PaperDeviceFrameEdges> frames_;
};

}  // namespace quadedge::frontend
