#include "stages/stereo_relaxation.hpp"

#include <limits>

#include "common/filter_limits.hpp"
#include "opencl/variants.hpp"

namespace quadedge::stages {

StereoRelaxation::StereoRelaxation(opencl::Context& context, int width, int height, const StereoConfig& config,
                                   const std::map<std::string, std::string>& variants)
    : context_(context), columns_(relaxation_cells(width)), cell_rows_(relaxation_cells(height)), config_(config) {
  const auto& variant = opencl::choose_variant("stereo_relaxation", context, variants);
  local_size_ = static_cast<std::size_t>(variant.local_size);
  const auto program = variant.program(context);
  start_ = {context, program, "relaxation_start"};
  round_ = {context, program, "relaxation_round"};
  choose_ = {context, program, "relaxation_choose"};
  tally_ = {context, program, "relaxation_tally"};
  consult_ = {context, program, "relaxation_consult"};
}

void StereoRelaxation::run(const DeviceEdges& left, const EpipolarGeometry& geometry,
                           const DeviceCandidates& candidates, const DeviceClusters& clusters,
                           DeviceRelaxation& relaxation, const CoarseDisparity* witness) {
  context_.begin_stage("stereo_relaxation");
  const auto edges = static_cast<std::size_t>(left.host_count);
  const auto capacity = static_cast<std::size_t>(candidates.capacity);
  const auto cells = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(cell_rows_);
  for (auto* values : {&relaxation.prior, &relaxation.belief, &relaxation.next_belief})
    values->ensure(context_, capacity);
  relaxation.slopes.ensure(context_, 2 * capacity);
  relaxation.chosen.ensure(context_, edges);
  relaxation.score.ensure(context_, edges);
  relaxation.cells.ensure(context_, cells);
  relaxation.cells.fill(std::numeric_limits<cl_int>::max(), cells);

  StereoRelaxationArguments arguments{};
  arguments.left = left.positions().at;
  arguments.capacity = candidates.capacity;
  arguments.columns = columns_;
  arguments.cell_rows = cell_rows_;
  arguments.similarity_min = lowest_similarity(config_);
  arguments.scale = static_cast<float>(config_.relaxation_scale);
  arguments.support_weight = support_weight(config_);
  arguments.score_min = static_cast<float>(config_.refined_ncc_min);
  arguments.undecided = kUndecided;
  arguments.coarse_reach = kCoarseReach;
  arguments.coarse_dissent = kCoarseDissent;
  arguments.geometry = geometry;
  const opencl::Range range(edges, local_size_);
  start_(range, arguments, candidates.first, clusters.count, left.packed, clusters.packed, relaxation.prior,
         relaxation.belief, relaxation.next_belief, relaxation.slopes, relaxation.cells);
  const auto vote = [&] {
    for (int round = 0; round < config_.relaxation_rounds; ++round) {
      round_(range, arguments, candidates.first, clusters.count, left.packed, clusters.packed, relaxation.slopes,
             relaxation.cells, relaxation.prior, relaxation.belief, relaxation.next_belief);
      relaxation.belief.swap(relaxation.next_belief);
    }
  };
  vote();
  relaxation.tally.ensure(context_, 2);
  relaxation.tally.fill(0, 2);
  tally_(range, arguments, candidates.first, clusters.count, relaxation.belief, relaxation.tally);
  relaxation.tally.read_later(&relaxation.host_tally.edges, 2);
  if (witness != nullptr) {
    arguments.coarse_columns = witness->search().width;
    arguments.coarse_rows = witness->search().height;
    consult_(range, arguments, candidates.first, clusters.count, left.packed, clusters.packed, witness->positions(),
             relaxation.prior, relaxation.belief, relaxation.next_belief);
    vote();
  }
  choose_(range, arguments, candidates.first, clusters.count, left.packed, clusters.packed, relaxation.slopes,
          relaxation.cells, relaxation.belief, relaxation.chosen, relaxation.score);
}

}  // namespace quadedge::stages
