/// \file stereo_matching.cpp  Counts, scans and fills candidates; then refinement, clusters, rounds of votes, choice.
#include "device/stereo_matching.hpp"

#include <cmath>
#include <limits>

#include "common/filter_limits.hpp"
#include "common/matching_constants.hpp"

namespace quadedge::stages {
namespace {

constexpr int kFirstCapacityPerEdge = 24;  // initial; grows as needed

}  // namespace

StereoCandidates::StereoCandidates(opencl::Context& context, const opencl::VariantChoice& variants, Turns turns)
    : Stage(context, "stereo_candidates", variants), scan_(context, variants) {
  const auto program = candidates_program(context, variant_, turns);
  count_ = {context, program, "stereo_candidates_count"};
  fill_ = {context, program, "stereo_candidates_fill"};
}

void StereoCandidates::run(const DeviceEdges& left, const DeviceEdges& right, int right_height,
                           const EpipolarGeometry& geometry, const DisparityProbe& probe,
                           DeviceCandidates& candidates) {
  begin();
  candidates.rows = left.host_count;
  candidates.counts.ensure(context_, static_cast<std::size_t>(left.host_count));
  noted_.ensure(context_, kNotedCandidates * static_cast<std::size_t>(left.host_count));
  listed_.ensure(context_, static_cast<std::size_t>(right.host_count));
  candidates.reserve(context_, kFirstCapacityPerEdge * left.host_count);
  const opencl::Range range = over(static_cast<std::size_t>(left.host_count));
  const StereoCandidateArguments arguments{left.positions().at, right.positions().at, right_height, geometry, probe};
  count_(range, arguments, left.packed, right.packed, right.row_first, candidates.counts, noted_, listed_);
  candidates.build(context_, scan_, [&] {
    fill_(range, arguments, left.packed, right.packed, right.row_first, candidates.first, candidates.capacity, noted_,
          candidates.target, listed_);
  });
}

StereoRefinement::StereoRefinement(opencl::Context& context, const StereoConfig& config, double patch_offset,
                                   const opencl::VariantChoice& variants, int max_value)
    : Stage(context, "stereo_refinement", variants), config_(config), patch_offset_(static_cast<float>(patch_offset)) {
  kernel_ = {context, variant_.program(context, image_defines(max_value)), "stereo_refinement"};
}

void StereoRefinement::run(const PixelCorners& left_image, const PixelCorners& right_image, const DeviceEdges& left,
                           const DeviceEdges& right, const opencl::Buffer<cl_char>& left_patches,
                           const EpipolarGeometry& geometry, DeviceCandidates& candidates, DeviceRefined& refined) {
  begin();
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
  arguments.shift_min_sine = static_cast<float>(std::sin(kShiftMinAngle));
  arguments.shift_max = static_cast<float>(kShiftMax);
  arguments.stiffness = static_cast<float>(std::pow(kRefinementNoise / config_.refine_prior_sigma, 2));
  arguments.alignment = {config_.refine_steps, static_cast<float>(config_.refine_tolerance),
                         static_cast<float>(kRefinementHuber), static_cast<float>(kRefinementClamp)};
  arguments.similarity_min = lowest_similarity(config_);
  arguments.rejected_order = order_of(StereoFilter::refinement);
  arguments.geometry = geometry;
  kernel_(over(static_cast<std::size_t>(candidates.rows), kPatchLanes), arguments, candidates.first, candidates.target,
          candidates.ncc, left_image.values(), right_image.values(), left_patches, left.packed, right.packed,
          candidates.state, refined.position, refined.similarity);
}

StereoClusters::StereoClusters(opencl::Context& context, const opencl::VariantChoice& variants)
    : Stage(context, "stereo_clusters", variants) {
  const auto program = variant_.program(context);
  cluster_ = {context, program, "stereo_clusters"};
}

void StereoClusters::run(const DeviceEdges& left, const DeviceEdges& right, const DeviceCandidates& candidates,
                         const DeviceRefined& refined, DeviceClusters& clusters) {
  begin();
  const auto edges = static_cast<std::size_t>(left.host_count);
  const auto capacity = static_cast<std::size_t>(candidates.capacity);
  clusters.order.ensure(context_, capacity);
  clusters.packed.ensure(context_, 3 * capacity);
  clusters.stride = candidates.capacity;
  clusters.anchor.ensure(context_, capacity);
  clusters.count.ensure(context_, edges);

  StereoClusterArguments arguments{};
  arguments.left = left.positions().at;
  arguments.right = right.positions().at;
  arguments.capacity = candidates.capacity;
  arguments.cluster_gap = static_cast<float>(kClusterGap);
  arguments.cluster_orientation = static_cast<float>(kClusterOrientation);
  arguments.cluster_size_max = kClusterSizeMax;
  arguments.cluster_sigma = static_cast<float>(kClusterSigma);
  cluster_(over(edges), arguments, candidates.first, candidates.target, right.packed, candidates.state,
           refined.position, refined.similarity, clusters.order, clusters.count, clusters.packed, clusters.anchor);
}

CoarseDisparity::CoarseDisparity(opencl::Context& context, const opencl::VariantChoice& variants, int max_value)
    : Stage(context, "coarse_disparity", variants) {
  strip_ = std::stoi(variant_.defines.at("COLUMNS"));
  const auto program = variant_.program(context, image_defines(max_value));
  halve_ = {context, program, "coarse_halve"};
  planes_ = {context, program, "coarse_planes"};
  rows_ = {context, program, "coarse_rows"};
  columns_ = {context, program, "coarse_columns"};
  choose_ = {context, program, "coarse_positions"};
}

void CoarseDisparity::prepare(const DeviceImage& image, int height, const PlaneRows& rows,
                              opencl::Buffer<cl_uchar>& planes) {
  const auto lines = static_cast<std::size_t>(height);
  half_.ensure(context_, lines * static_cast<std::size_t>(rows.width));
  planes.ensure(context_, lines * kCoarsePlanes * static_cast<std::size_t>(rows.stride));
  const opencl::Range range = over(lines, local_size_);
  halve_(range, image.pixels, image.width, rows.width, half_);
  planes_(range, half_, rows.width, height, rows.front, rows.stride, rows.mirrored ? 1 : 0, planes);
}

std::size_t CoarseDisparity::bytes(const CoarseDisparityArguments& search) {
  const auto width = static_cast<std::size_t>(search.width), stride = static_cast<std::size_t>(search.right_stride);
  const std::size_t volume = width * static_cast<std::size_t>(search.levels) * (sizeof(cl_uchar) + sizeof(cl_ushort));
  const std::size_t planes = (kCoarsePlanes + 1) * (width + stride);
  return static_cast<std::size_t>(search.height) *
         (volume + planes + stride * sizeof(cl_uint) + width * sizeof(cl_float));
}

void CoarseDisparity::run(const DeviceImage& left, const DeviceImage& right, const CoarseDisparityArguments& search) {
  begin();
  search_ = search;
  const auto lines = static_cast<std::size_t>(search.height), columns = static_cast<std::size_t>(search.width),
             cells = lines * columns * static_cast<std::size_t>(search.levels);
  prepare(left, search.height, {search.width, 0, search.width, false}, left_planes_);
  prepare(right, search.height, {search.right_width, search.right_front, search.right_stride, true}, right_planes_);
  costs_.ensure(context_, cells);
  sums_.ensure(context_, cells);
  lowest_.ensure(context_, lines * static_cast<std::size_t>(search.right_stride));
  positions_.ensure(context_, lines * columns);
  const auto strip = static_cast<std::size_t>(strip_);
  const opencl::Range range = over(lines, local_size_);
  rows_(range, search, left_planes_, right_planes_, costs_, sums_);
  columns_(over((columns + strip - 1) / strip, local_size_), search, costs_, sums_);
  choose_(range, search, sums_, lowest_, positions_);
}

StereoRelaxation::StereoRelaxation(opencl::Context& context, int width, int height, const StereoConfig& config,
                                   const opencl::VariantChoice& variants)
    : Stage(context, "stereo_relaxation", variants),
      columns_(relaxation_cells(width)),
      cell_rows_(relaxation_cells(height)),
      config_(config) {
  const auto program = variant_.program(context);
  start_ = {context, program, "relaxation_start"};
  round_ = {context, program, "relaxation_round"};
  choose_ = {context, program, "relaxation_choose"};
  tally_ = {context, program, "relaxation_tally"};
  consult_ = {context, program, "relaxation_consult"};
}

void StereoRelaxation::run(const DeviceEdges& left, const EpipolarGeometry& geometry,
                           const DeviceCandidates& candidates, const DeviceClusters& clusters,
                           DeviceRelaxation& relaxation, const CoarseDisparity* coarse_disparity) {
  begin();
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
  arguments.scale = static_cast<float>(kRelaxationScale);
  arguments.support_weight = support_weight(config_);
  arguments.score_min = static_cast<float>(config_.refined_ncc_min);
  arguments.undecided = kUndecided;
  arguments.coarse_reach = kCoarseReach;
  arguments.coarse_dissent = kCoarseDissent;
  arguments.geometry = geometry;
  const opencl::Range range = over(edges);
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
  if (coarse_disparity != nullptr) {
    arguments.coarse_columns = coarse_disparity->search().width;
    arguments.coarse_rows = coarse_disparity->search().height;
    consult_(range, arguments, candidates.first, clusters.count, left.packed, clusters.packed,
             coarse_disparity->positions(), relaxation.prior, relaxation.belief, relaxation.next_belief);
    vote();
  }
  choose_(range, arguments, candidates.first, clusters.count, left.packed, clusters.packed, relaxation.slopes,
          relaxation.cells, relaxation.belief, relaxation.chosen, relaxation.score);
}

StereoMutual::StereoMutual(opencl::Context& context, const StereoConfig& config, const opencl::VariantChoice& variants)
    : Stage(context, "stereo_mutual", variants),
      mutual_radius_(static_cast<float>(config.mutual_radius)),
      scan_(context, variants) {
  const auto program = variant_.program(context);
  claim_ = {context, program, "stereo_claim"};
  owner_ = {context, program, "stereo_owner"};
  mutual_ = {context, program, "stereo_mutual"};
  collect_ = {context, program, "stereo_collect"};
}

void StereoMutual::run(const DeviceEdges& left, const DeviceEdges& right, Patches& right_patches,
                       const EpipolarGeometry& geometry, const EpipolarGeometry* searched,
                       const DeviceClusters& clusters, const DeviceRelaxation& relaxation, DeviceStereoEdges& result,
                       StereoEdges& edges) {
  begin();
  const int n = left.host_count;
  const auto left_edges = static_cast<std::size_t>(n), right_edges = static_cast<std::size_t>(right.host_count);
  keep_.ensure(context_, left_edges);
  claimed_.ensure(context_, right_edges);
  owners_.ensure(context_, right_edges);
  claimed_.fill(0, right_edges);
  owners_.fill(std::numeric_limits<cl_int>::max(), right_edges);

  StereoMutualArguments arguments{};
  arguments.left = left.positions().at;
  arguments.capacity = clusters.stride;
  arguments.mutual_radius = mutual_radius_;
  const opencl::Range range = over(left_edges);
  claim_(range, arguments, relaxation.chosen, relaxation.score, clusters.anchor, claimed_);
  owner_(range, arguments, relaxation.chosen, relaxation.score, clusters.anchor, claimed_, owners_);
  mutual_(range, arguments, relaxation.chosen, clusters.anchor, left.packed, owners_, keep_);
  result.reserve(context_, left_edges);
  result.stride = n;
  scan_.run(keep_, n, n, keep_first_, result.total);
  const auto collect = [&](const EpipolarGeometry& lines) {
    arguments.geometry = lines;
    collect_(range, arguments, keep_first_, relaxation.chosen, left.packed, clusters.packed, clusters.anchor,
             result.left_index, result.right_index, result.packed, result.ncc);
  };
  collect(geometry);
  result.read(context_, read_back_, edges);
  if (searched != nullptr) collect(*searched);
  right_patches.cut(result.positions(Side::right), result.right_patches);
  if (searched != nullptr) collect(geometry);
}

}  // namespace quadedge::stages
