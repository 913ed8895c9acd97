/// \file paper_refinement.cpp  One launch over the rows of a list.
#include "device/paper_refinement.hpp"

#include <cmath>

#include "common/matching_constants.hpp"

namespace quadedge::stages {

PaperRefinement::PaperRefinement(opencl::Context& context, const StereoConfig& config,
                                 const opencl::VariantChoice& variants, int max_value)
    : Stage(context, "paper_refinement", variants), config_(config) {
  const auto program = variant_.program(context, image_defines(max_value));
  along_line_ = {context, program, "paper_refine_stereo"};
  freely_ = {context, program, "paper_refine_free"};
}

void PaperRefinement::in_stereo(const PaperEdges& left, const PaperEdges& right, const EpipolarGeometry& geometry,
                                const DeviceCandidates& candidates, opencl::Buffer<cl_float>& refined) {
  run(along_line_, left, right, geometry, candidates, refined);
}

void PaperRefinement::in_time(const PaperEdges& before, const PaperEdges& now, const DeviceCandidates& candidates,
                              opencl::Buffer<cl_float>& refined) {
  run(freely_, before, now, {}, candidates, refined);
}

void PaperRefinement::run(const Refine& kernel, const PaperEdges& fixed, const PaperEdges& moving,
                          const EpipolarGeometry& geometry, const DeviceCandidates& candidates,
                          opencl::Buffer<cl_float>& refined) {
  begin();
  refined.ensure(context_, 2 * static_cast<std::size_t>(candidates.capacity));
  if (candidates.rows == 0) return;
  PaperRefinementArguments arguments{};
  arguments.fixed = fixed.positions.at;
  arguments.moving = moving.positions.at;
  arguments.capacity = candidates.capacity;
  arguments.fixed_width = fixed.picture.width;
  arguments.fixed_height = fixed.picture.height;
  arguments.moving_width = moving.picture.width;
  arguments.moving_height = moving.picture.height;
  arguments.offset = static_cast<float>(kPaperRefinementOffset);
  arguments.steps = config_.refine_steps;
  arguments.tolerance = static_cast<float>(config_.refine_tolerance);
  arguments.huber = static_cast<float>(kRefinementHuber);
  arguments.both_sides = config_.refine_sides == "both" ? 1 : 0;
  arguments.shift_min_sine = static_cast<float>(std::sin(kShiftMinAngle));
  arguments.shift_max = static_cast<float>(kShiftMax);
  arguments.largest_residual = static_cast<float>(kPaperLargestResidual);
  arguments.geometry = geometry;
  kernel(over(static_cast<std::size_t>(candidates.rows)), arguments, candidates.first, candidates.target,
         candidates.state, fixed.picture.records, moving.picture.records, fixed.positions.packed,
         moving.positions.packed, fixed.patches, moving.patches, refined);
}

}  // namespace quadedge::stages
