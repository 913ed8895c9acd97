/// \file paper_matching.cpp  Launches over pixels, edges and rows of lists; the host reads clusters without gaps, and
/// quads.
#include "device/paper_matching.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/matching_constants.hpp"

namespace quadedge::stages {

PaperPatches::PaperPatches(opencl::Context& context, int width, int height, const opencl::VariantChoice& variants,
                           int max_value)
    : Stage(context, "paper_patches", variants), words_per_record_(2 * bytes_per_pixel(max_value)) {
  picture_.width = width;
  picture_.height = height;
  const auto program = variant_.program(context, image_defines(max_value));
  prepare_ = {context, program, "paper_picture"};
  cut_ = {context, program, "paper_patches"};
}

void PaperPatches::prepare(const opencl::Buffer<cl_uchar>& image) {
  begin();
  const auto columns = static_cast<std::size_t>(picture_.width) + 1, rows = static_cast<std::size_t>(picture_.height);
  picture_.records.ensure(context_, columns * rows * words_per_record_);
  prepare_({columns, rows, local_size_, 1}, image, picture_.width, picture_.height, picture_.records);
}

void PaperPatches::cut(const PositionsView& edges, double offset, opencl::Buffer<cl_float>& patches) {
  begin();
  const auto count = static_cast<std::size_t>(edges.at.count);
  patches.ensure(context_, count * kPaperPatchFloats);
  if (count == 0) return;
  cut_(over(count), {picture_.width, picture_.height, static_cast<float>(offset), 1, edges.at}, picture_.records,
       edges.packed, patches);
}

PaperFilters::PaperFilters(opencl::Context& context, const opencl::VariantChoice& variants)
    : Stage(context, "paper_filters", variants), unused_(context, 1) {
  const auto program = variant_.program(context);
  ncc_ = {context, program, "paper_ncc"};
  decide_ = {context, program, "candidate_filters"};
}

void PaperFilters::run(const PaperDescribedEdges& a, const PaperDescribedEdges& b, const FilterLimits& limits,
                       int row_step, bool all_scores, DeviceCandidates& candidates) {
  begin();
  candidates.alive.ensure(context_, static_cast<std::size_t>(candidates.rows));
  const FilterArguments arguments{candidates.rows, row_step, candidates.capacity, all_scores ? 1 : 0, limits};
  const opencl::Range rows = over(static_cast<std::size_t>(candidates.rows));
  ncc_(rows, arguments, candidates.first, candidates.target, a.patches, a.number_of, b.patches, b.number_of,
       candidates.ncc);
  decide_(rows, arguments, candidates.first, candidates.target, unused_, a.number_of, a.sift, unused_, b.number_of,
          b.sift, candidates.ncc, candidates.sift, candidates.state, candidates.alive);
}

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

PaperClusters::PaperClusters(opencl::Context& context, const opencl::VariantChoice& variants, int max_value)
    : Stage(context, "paper_clusters", variants), scan_(context, variants) {
  const auto program = variant_.program(context, image_defines(max_value));
  count_ = {context, program, "paper_alive_counts"};
  cluster_ = {context, program, "paper_clusters"};
  compare_ = {context, program, "paper_similarity"};
}

void PaperClusters::cluster(const PositionsView& moving, const DeviceCandidates& candidates,
                            const opencl::Buffer<cl_float>& refined, DevicePaperClusters& clusters) {
  begin();
  const auto rows = static_cast<std::size_t>(candidates.rows);
  clusters.rows = candidates.rows;
  if (rows == 0) return;
  alive_.ensure(context_, rows);
  count_(over(rows), candidates.rows, candidates.capacity, candidates.first, candidates.state, alive_);
  scan_.run(alive_, candidates.rows, std::numeric_limits<cl_int>::max(), clusters.first, total_);
  cl_int total[2];
  total_.read(total, 2);
  clusters.stride = std::max(1, total[0]);
  const auto capacity = static_cast<std::size_t>(clusters.stride);
  clusters.scratch.ensure(context_, 2 * capacity);
  clusters.count.ensure(context_, rows);
  clusters.packed.ensure(context_, 4 * capacity);
  clusters.member_first.ensure(context_, 2 * capacity);
  clusters.members.ensure(context_, capacity);
  const PaperClusterArguments arguments{moving.at,
                                        candidates.rows,
                                        candidates.capacity,
                                        clusters.stride,
                                        static_cast<float>(kClusterGap),
                                        static_cast<float>(kClusterOrientation),
                                        kClusterSizeMax,
                                        static_cast<float>(kClusterSigma)};
  cluster_(over(rows), arguments, candidates.first, candidates.target, candidates.state, clusters.first, moving.packed,
           refined, clusters.scratch, clusters.count, clusters.packed, clusters.member_first, clusters.members);
}

void PaperClusters::compare(const DevicePicture& right, const opencl::Buffer<cl_float>& left_patches, double offset,
                            double ncc_min, DevicePaperClusters& clusters) {
  begin();
  const auto rows = static_cast<std::size_t>(clusters.rows);
  clusters.chosen.ensure(context_, rows);
  if (rows == 0) return;
  const PaperSimilarityArguments arguments{clusters.rows,
                                           clusters.stride,
                                           right.width,
                                           right.height,
                                           static_cast<float>(offset),
                                           static_cast<float>(ncc_min)};
  compare_(over(rows), arguments, clusters.first, clusters.count, right.records, left_patches, clusters.packed,
           clusters.chosen);
}

DevicePaperClusters::Lists DevicePaperClusters::read(bool compared) const {
  const auto size = static_cast<std::size_t>(stride), all = static_cast<std::size_t>(rows);
  Lists lists;
  lists.first.push_back(0);
  lists.member_first.push_back(0);
  if (rows == 0) return lists;
  const auto from = first.read(all), counts = count.read(all);
  const auto values = packed.read(4 * size);
  const auto starts = member_first.read(2 * size), targets = members.read(size);
  if (compared) lists.chosen = chosen.read(all);
  for (std::size_t i = 0; i < all; ++i) {
    if (compared && lists.chosen[i] >= 0) lists.chosen[i] += lists.first.back();
    for (auto k = static_cast<std::size_t>(from[i]); k < static_cast<std::size_t>(from[i] + counts[i]); ++k) {
      lists.x.push_back(values[k]);
      lists.y.push_back(values[size + k]);
      lists.direction.push_back(values[2 * size + k]);
      if (compared) lists.similarity.push_back(values[3 * size + k]);
      const auto begin = targets.begin() + starts[k];
      lists.members.insert(lists.members.end(), begin, begin + starts[size + k]);
      lists.member_first.push_back(static_cast<std::int32_t>(lists.members.size()));
    }
    lists.first.push_back(static_cast<std::int32_t>(lists.x.size()));
  }
  return lists;
}

PaperQuads::PaperQuads(opencl::Context& context, const opencl::VariantChoice& variants)
    : Stage(context, "paper_quads", variants), scan_(context, variants) {
  const auto program = variant_.program(context);
  count_ = {context, program, "paper_quad_counts"};
  fill_ = {context, program, "paper_quads"};
}

void PaperQuads::run(const Image& left, const Image& right, TemporalMatches& matches) {
  begin();
  matches.clear();
  const auto rows = static_cast<std::size_t>(left.candidates.rows);
  if (rows == 0) return;
  PaperQuadArguments arguments{left.candidates.rows, left.clusters.stride, right.clusters.stride, 0};
  counts_.ensure(context_, rows);
  count_(over(rows), arguments, left.clusters.first, left.clusters.count, left.clusters.member_first,
         left.clusters.members, right.clusters.first, right.clusters.count, right.clusters.member_first,
         right.clusters.members, counts_);
  scan_.run(counts_, arguments.rows, std::numeric_limits<cl_int>::max(), first_, total_);
  cl_int total[2];
  total_.read(total, 2);
  matches.alive_left = count_positive(left.clusters.count, left.candidates.rows);
  matches.alive_right = count_positive(right.clusters.count, left.candidates.rows);
  const auto quads = static_cast<std::size_t>(total[0]);
  if (quads == 0) return;
  arguments.capacity = total[0];
  places_.ensure(context_, 7 * quads);
  numbers_.ensure(context_, 3 * quads);
  fill_(over(rows), arguments, left.clusters.first, left.clusters.count, left.clusters.member_first,
        left.clusters.members, left.clusters.packed, left.candidates.first, left.candidates.target, left.candidates.ncc,
        right.clusters.first, right.clusters.count, right.clusters.member_first, right.clusters.members,
        right.clusters.packed, right.candidates.first, right.candidates.target, right.candidates.ncc, first_, places_,
        numbers_);
  const opencl::CopyGuard guard(context_);
  std::size_t block = 0;
  for (auto* values : {&matches.left_x, &matches.left_y, &matches.left_direction, &matches.right_x, &matches.right_y,
                       &matches.right_direction, &matches.ncc}) {
    values->resize(quads);
    places_.read_later(values->data(), quads, quads * block++);
  }
  block = 0;
  for (auto* values : {&matches.previous, &matches.current, &matches.competing_clusters}) {
    values->resize(quads);
    numbers_.read_later(values->data(), quads, quads * block++);
  }
  context_.finish();
}

}  // namespace quadedge::stages
