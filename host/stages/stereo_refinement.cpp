#include "stages/stereo_refinement.hpp"

#include <cmath>

#include "common/filter_limits.hpp"
#include "common/stereo_constants.hpp"
#include "opencl/variants.hpp"
#include "stages/device_image.hpp"

namespace quadedge::stages {
StereoRefinement::StereoRefinement(opencl::Context& context, const StereoConfig& config, double patch_offset,
                                   const std::map<std::string, std::string>& variants, int max_value)
    : context_(context), config_(config), patch_offset_(static_cast<float>(patch_offset)) {
  const auto& variant = opencl::choose_variant("stereo_refinement", context, variants);
  local_size_ = static_cast<std::size_t>(variant.local_size);
  items_per_edge_ = variant.form == opencl::Form::groups ? kPatchLanes : 1;
  kernel_ = {context, variant.program(context, image_defines(max_value)), "stereo_refinement"};
}

void StereoRefinement::run(const PixelCorners& left_image, const PixelCorners& right_image, const DeviceEdges& left,
                           const DeviceEdges& right, const opencl::Buffer<cl_char>& left_patches,
                           const EpipolarGeometry& geometry, DeviceCandidates& candidates, DeviceRefined& refined) {
  context_.begin_stage("stereo_refinement");
  refined.position.ensure(context_, static_cast<std::size_t>(candidates.capacity));
  refined.similarity.ensure(context_, static_cast<std::size_t>(candidates.capacity));
  StereoRefinementArguments arguments{};
  arguments.left = left.positions().at;
  arguments.right = right.positions().at;
  arguments.capacity = candidates.capacity;
  arguments.left_width = left_image.width();
  arguments.left_height = left_image.height();
  arguments.right_width = right_image.width();
  arguments.right_height = right_image.height();
  arguments.patch_offset = patch_offset_;
  arguments.shift_min_sine = static_cast<float>(std::sin(config_.shift_min_angle_rad()));
  arguments.shift_max = static_cast<float>(config_.shift_max);
  arguments.stiffness = static_cast<float>(std::pow(kRefinementNoise / config_.refine_prior_sigma, 2));
  arguments.alignment = {config_.refine_steps, static_cast<float>(config_.refine_tolerance),
                         static_cast<float>(kRefinementHuber), static_cast<float>(kRefinementClamp)};
  arguments.similarity_min = lowest_similarity(config_);
  arguments.rejected_order = order_of(StereoFilter::refinement);
  arguments.geometry = geometry;
  kernel_({static_cast<std::size_t>(candidates.rows) * items_per_edge_, local_size_}, arguments, candidates.first,
          candidates.target, candidates.ncc, left_image.values(), right_image.values(), left_patches, left.packed,
          right.packed, candidates.state, refined.position, refined.similarity);
}

}  // namespace quadedge::stages
