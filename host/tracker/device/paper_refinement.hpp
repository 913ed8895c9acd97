#pragma once
/// \file paper_refinement.hpp  The photometric refinement of the paper's method, along the epipolar line or freely.

#include "device/candidates.hpp"
#include "device/paper_patches.hpp"
#include "quadedge/config.hpp"

namespace quadedge::stages {

/// Edges of an image as the refinement takes them.
struct PaperEdges {
  const DevicePicture& picture;
  PositionsView positions;
  const opencl::Buffer<cl_float>& patches;  ///< PaperPatches::cut(); read only where refine_sides is "best"
};

/// Moves the alive candidates of a list until their patches look like those of the row's edge.
/// Variants of the stage "paper_refinement".
class PaperRefinement : private Stage {
 public:
  PaperRefinement(opencl::Context& context, const StereoConfig& config, const opencl::VariantChoice& variants,
                  int max_value = kMaxValue8);

  /// Positions of right edges on the epipolar lines of left edges, the rows. `refined`: two blocks of
  /// candidates.capacity floats, x and y [px]; those of other candidates are left as they are.
  void in_stereo(const PaperEdges& left, const PaperEdges& right, const EpipolarGeometry& geometry,
                 const DeviceCandidates& candidates, opencl::Buffer<cl_float>& refined);
  /// Positions of edges of the current image that look like those of the earlier one, the rows.
  void in_time(const PaperEdges& before, const PaperEdges& now, const DeviceCandidates& candidates,
               opencl::Buffer<cl_float>& refined);

 private:
  using Refine = opencl::Kernel<void(PaperRefinementArguments args, const cl_int* first, const cl_int* target,
                                     const cl_uchar* state, const cl_uint* fixed_records, const cl_uint* moving_records,
                                     const cl_float* fixed_edges, const cl_float* moving_edges,
                                     const cl_float* fixed_patches, const cl_float* moving_patches, cl_float* refined)>;
  void run(const Refine& kernel, const PaperEdges& fixed, const PaperEdges& moving, const EpipolarGeometry& geometry,
           const DeviceCandidates& candidates, opencl::Buffer<cl_float>& refined);

  StereoConfig config_;
  Refine along_line_, freely_;
};

}  // namespace quadedge::stages
