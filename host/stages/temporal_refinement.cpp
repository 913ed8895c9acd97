#include "stages/temporal_refinement.hpp"

#include <cmath>

#include "opencl/variants.hpp"
#include "reference/temporal_refinement.hpp"

namespace quadedge::stages {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

}  // namespace

TemporalRefinement::TemporalRefinement(opencl::Context& context, const TemporalConfig& config, double patch_offset,
                                       const std::map<std::string, std::string>& variants)
    : context_(context),
      config_(config),
      patch_offset_(static_cast<float>(patch_offset)),
      previous_left_(context),
      previous_right_(context),
      current_left_(context),
      current_right_(context) {
  const auto& variant = opencl::choose_variant("temporal_refinement", context, variants);
  local_size_ = static_cast<std::size_t>(variant.local_size);
  const auto program =
      context.program({"direction.cl", "epipolar.cl", "photometric.cl", "temporal_refinement.cl"}, variant.defines);
  agree_ = {context, program, "temporal_agreement"};
  refine_ = {context, program, "temporal_refinement"};
  cluster_ = {context, program, "temporal_clusters"};
}

void TemporalRefinement::agree(DeviceCandidates& left, const DeviceCandidates& right) {
  context_.begin_stage("temporal_refinement");
  const auto capacity = static_cast<std::size_t>(left.capacity);
  score_.ensure(context_, capacity);
  right_pairing_.ensure(context_, capacity);
  agree_({static_cast<std::size_t>(left.rows), local_size_}, left.first, left.target, left.capacity, left.ncc, left.rejected_by,
         right.first, right.target, right.capacity, right.ncc, right.pairing, right.rejected_by, left.rows,
         reference::kAgreementOrder, score_, right_pairing_);
}

void TemporalRefinement::refine(const DeviceRig& previous, const DeviceRig& current, int row_step,
                                const opencl::Buffer<cl_float>& geometry, DeviceCandidates& left) {
  refined_.ensure(context_, 4 * static_cast<std::size_t>(left.capacity));
  const auto stiffness = static_cast<float>(std::pow(config_.refine_noise / config_.refine_prior, 2));
  previous_left_.prepare(previous.left.pixels, previous.left.width, previous.left.height);
  previous_right_.prepare(previous.right.pixels, previous.right.width, previous.right.height);
  current_left_.prepare(current.left.pixels, current.left.width, current.left.height);
  current_right_.prepare(current.right.pixels, current.right.width, current.right.height);
  refine_({static_cast<std::size_t>(left.rows), local_size_}, left.first, left.target, left.capacity, left.rows, row_step,
          previous_left_.values(), previous_right_.values(), current_left_.values(), current_right_.values(),
          current.left.width, current.left.height, current.right.width, current.right.height, previous.edges.packed, previous.edges.stride,
          current.edges.packed, current.edges.stride, geometry, left.pairing, right_pairing_, patch_offset_, stiffness,
          config_.refine_steps, static_cast<float>(config_.refine_tolerance), static_cast<float>(config_.refine_huber),
          static_cast<float>(config_.refine_clamp), static_cast<float>(config_.refine_rms_max),
          reference::kTemporalRefinementOrder, left.rejected_by, refined_);
}

TemporalMatches TemporalRefinement::collect(const DeviceRig& current, int row_step, const DeviceCandidates& left) {
  const auto rows = static_cast<std::size_t>(left.rows);
  label_.ensure(context_, static_cast<std::size_t>(left.capacity));
  best_.ensure(context_, rows);
  rivals_.ensure(context_, rows);
  best_score_.ensure(context_, rows);
  best_place_.ensure(context_, 4 * rows);
  cluster_({rows, local_size_}, left.first, left.target, left.capacity, left.rows, current.edges.packed, current.edges.stride,
           left.rejected_by, refined_, score_, static_cast<float>(config_.cluster_gap),
           static_cast<float>(config_.cluster_orientation * kDegree), label_, best_, rivals_, best_score_, best_place_);
  const auto best = best_.read(rows);
  const auto rivals = rivals_.read(rows);
  const auto scores = best_score_.read(rows);
  const auto places = best_place_.read(4 * rows);
  TemporalMatches matches;
  for (std::size_t row = 0; row < rows; ++row) {
    if (best[row] < 0) continue;
    matches.previous.push_back(static_cast<std::int32_t>(row) * row_step);
    matches.current.push_back(best[row]);
    matches.left_x.push_back(places[4 * row]);
    matches.left_y.push_back(places[4 * row + 1]);
    matches.right_x.push_back(places[4 * row + 2]);
    matches.right_y.push_back(places[4 * row + 3]);
    matches.ncc.push_back(scores[row]);
    matches.rivals.push_back(rivals[row]);
  }
  return matches;
}

}  // namespace quadedge::stages
