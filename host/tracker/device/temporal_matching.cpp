/// \file temporal_matching.cpp  Sorts edges into cells; quads by one fused kernel, or by lists that a tap can see.
#include "device/temporal_matching.hpp"

#include "common/matching_constants.hpp"
#include "quadedge/tap.hpp"

namespace quadedge::stages {
namespace {

constexpr int kFirstCapacityPerRow = 48;  // initial; grows as needed

int count_blocks(int descriptors) { return (descriptors + kBlockLanes - 1) / kBlockLanes; }

}  // namespace

DevicePointIndex::DevicePointIndex(int width, int height) {
  layout_.columns = static_cast<int>((static_cast<float>(width) + kCellWidth - 1) / kCellWidth);
  layout_.rows = static_cast<int>((static_cast<float>(height) + kCellHeight - 1) / kCellHeight);
}

void DevicePointIndex::resize(opencl::Context& context, int count) {
  layout_.points = {0, count, count};
  points.ensure(context, 3 * static_cast<std::size_t>(count));
  cells.ensure(context, static_cast<std::size_t>(layout_.columns * layout_.rows + 1 + count));
}

PointIndex::PointIndex(opencl::Context& context, const opencl::VariantChoice& variants)
    : Stage(context, "point_index", variants), scan_(context, variants) {
  const auto program = variant_.program(context);
  if (!is_grouped()) {
    kernel_ = {context, program, "point_index"};
    return;
  }
  count_ = {context, program, "point_index_count"};
  place_ = {context, program, "point_index_place"};
  sort_ = {context, program, "point_index_sort"};
}

void PointIndex::run(const PositionsView& left_edges, const PositionsView& right_edges, DevicePointIndex& left,
                     DevicePointIndex& right) {
  begin();
  left.resize(context_, left_edges.at.count);
  right.resize(context_, right_edges.at.count);
  const PointIndexArguments arguments{left_edges.at, right_edges.at, left.layout(), right.layout()};
  if (is_grouped()) {
    run_in_groups(arguments, left_edges, right_edges, left, right);
    return;
  }
  constexpr std::size_t kSideCount = 2;
  kernel_(over(kSideCount), arguments, left_edges.packed, right_edges.packed, left.points, left.cells, right.points,
          right.cells);
}

void PointIndex::run_in_groups(const PointIndexArguments& arguments, const PositionsView& left_edges,
                               const PositionsView& right_edges, DevicePointIndex& left, DevicePointIndex& right) {
  const int cells = left.cell_count() + right.cell_count(), edges = left_edges.at.count + right_edges.at.count;
  const auto cell_items = static_cast<std::size_t>(cells), edge_items = static_cast<std::size_t>(edges);
  counts_.ensure(context_, cell_items);
  numbers_.ensure(context_, edge_items);
  counts_.fill(0, cell_items);
  count_(over(edge_items), arguments, left_edges.packed, right_edges.packed, counts_);
  scan_.run(counts_, cells, edges, first_, total_);
  place_(over(edge_items), arguments, left_edges.packed, right_edges.packed, first_, counts_, numbers_);
  sort_(over(cell_items), arguments, left_edges.packed, right_edges.packed, first_, numbers_, left.points, left.cells,
        right.points, right.cells);
}

TemporalCandidates::TemporalCandidates(opencl::Context& context, const opencl::VariantChoice& variants, Turns turns)
    : Stage(context, "temporal_candidates", variants), scan_(context, variants) {
  const auto program = candidates_program(context, variant_, turns);
  count_ = {context, program, "temporal_candidates_count"};
  fill_ = {context, program, "temporal_candidates_fill"};
}

void TemporalCandidates::run(const PositionsView& predicted, int row_step, const DevicePointIndex& current,
                             float radius, float orientation, DeviceCandidates& candidates) {
  begin();
  candidates.rows = (predicted.at.count + row_step - 1) / row_step;
  candidates.counts.ensure(context_, static_cast<std::size_t>(candidates.rows));
  candidates.reserve(context_, kFirstCapacityPerRow * candidates.rows);
  const opencl::Range range = over(static_cast<std::size_t>(candidates.rows));
  const TemporalCandidateArguments arguments{candidates.rows,  row_step, predicted.at,
                                             current.layout(), radius,   orientation};
  count_(range, arguments, predicted.packed, current.points, current.cells, candidates.counts);
  candidates.build(context_, scan_, [&] {
    fill_(range, arguments, predicted.packed, current.points, current.cells, candidates.first, candidates.capacity,
          candidates.target);
  });
}

TemporalMatch::TemporalMatch(opencl::Context& context, const TemporalConfig& config,
                             const opencl::VariantChoice& variants)
    : Stage(context, "temporal_match", variants), config_(config) {
  if (variant_.form != opencl::Form::lists) kernel_ = {context, variant_.program(context), "temporal_match"};
}

bool TemporalMatch::read_quads(std::size_t rows, int step, const StereoEdges& edges, TemporalMatches& matches) {
  matches.clear();
  bool fits = true;
  read_back_.read(context_, result_, kQuadRowInts * rows, [&](const cl_int* values) {
    for (std::size_t row = 0; row < rows; ++row, values += kQuadRowInts) {
      fits = (values[3] & kRowOverflow) == 0;
      if (!fits) break;
      matches.alive_left += (values[3] & kLeftAlive) != 0 ? 1 : 0;
      matches.alive_right += (values[3] & kRightAlive) != 0 ? 1 : 0;
      append_row(values, static_cast<std::int32_t>(row) * step, edges, matches);
    }
  });
  return fits;
}

bool TemporalMatch::run(const DevicePositions& predicted, const TemporalSearch& search, const DeviceStereoEdges& base,
                        const DeviceStereoEdges& current, const DevicePointIndex& left, const DevicePointIndex& right,
                        const StereoEdges& edges, TemporalMatches& matches) {
  begin();
  const PositionsView left_predicted = predicted.list(0), right_predicted = predicted.list(1);
  const int count = (left_predicted.at.count + search.step - 1) / search.step;
  const auto rows = static_cast<std::size_t>(count);
  result_.ensure(context_, kQuadRowInts * rows);
  const FilterLimits limits = temporal_limits(config_, search);
  const TemporalMatchArguments arguments{count,
                                         search.step,
                                         left_predicted.at,
                                         right_predicted.at,
                                         left.layout(),
                                         right.layout(),
                                         current.positions(Side::left).at,
                                         search.radius,
                                         static_cast<float>(kTemporalOrientation),
                                         limits.ncc_min,
                                         limits.ncc_nearly_best,
                                         quad_choice(config_, search)};
  kernel_(over(rows, local_size_), arguments, left_predicted.packed, left.points, left.cells, right.points, right.cells,
          base.left_patches, base.left_index, base.right_patches, current.left_patches, current.left_index,
          current.right_patches, current.packed, result_);
  return read_quads(rows, search.step, edges, matches);
}

TemporalQuads::TemporalQuads(opencl::Context& context, const TemporalConfig& config,
                             const opencl::VariantChoice& variants)
    : Stage(context, "temporal_quads", variants), config_(config) {
  const auto program = variant_.program(context);
  agree_ = {context, program, "temporal_agreement"};
  best_ = {context, program, "temporal_best"};
}

void TemporalQuads::agree(DeviceCandidates& left, const DeviceCandidates& right) {
  begin();
  score_.ensure(context_, static_cast<std::size_t>(left.capacity));
  agree_(over(static_cast<std::size_t>(left.rows)),
         {left.rows, left.capacity, right.capacity, order_of(TemporalFilter::agreement)}, left.first, left.target,
         left.ncc, left.state, right.first, right.target, right.ncc, right.state, score_);
}

TemporalMatches TemporalQuads::collect(const DeviceStereoEdges& current, const StereoEdges& edges,
                                       const TemporalSearch& search, const PositionsView& predicted,
                                       const DeviceCandidates& left) {
  const auto rows = static_cast<std::size_t>(left.rows);
  label_.ensure(context_, static_cast<std::size_t>(left.capacity));
  result_.ensure(context_, kQuadRowInts * rows);
  best_(over(rows),
        {left.rows, search.step, left.capacity, predicted.at, current.positions(Side::left).at,
         quad_choice(config_, search)},
        left.first, left.target, left.state, score_, predicted.packed, current.packed, label_, result_);
  const auto result = result_.read(kQuadRowInts * rows);
  TemporalMatches matches;
  for (std::size_t row = 0; row < rows; ++row)
    append_row(result.data() + kQuadRowInts * row, static_cast<std::int32_t>(row) * search.step, edges, matches);
  return matches;
}

GlobalMatching::GlobalMatching(opencl::Context& context, const opencl::VariantChoice& variants)
    : Stage(context, "global_matching", variants),
      neighbourhood_(static_cast<float>(kWideNeighbourhood)),
      ratio_(static_cast<float>(kWideRatio)),
      rows_at_once_(std::stoul(variant_.defines.at("ROWS"))) {
  const auto program = variant_.program(context);
  if (!is_grouped()) {
    transpose_ = {context, program, "wide_transpose"};
    blocks_kernel_ = {context, program, "global_match"};
  } else {
    kernel_ = {context, program, "global_match"};
  }
}

void GlobalMatching::transpose(const DeviceWideEdges& edges, opencl::Buffer<cl_uchar>& blocks) {
  const int count = count_blocks(edges.rows);
  blocks.ensure(context_, static_cast<std::size_t>(count) * kBlockLanes * kWideBytes);
  transpose_(over(static_cast<std::size_t>(count)), edges.descriptors, edges.rows, blocks);
}

TemporalMatches GlobalMatching::run(const DeviceWideEdges& earlier, const DeviceWideEdges& current,
                                    const StereoEdges& current_edges) {
  begin();
  const auto rows = static_cast<std::size_t>(earlier.rows);
  best_.ensure(context_, rows);
  similarity_.ensure(context_, rows);
  const GlobalMatchingArguments arguments{{earlier.edges.stride, earlier.rows, earlier.step},
                                          {current.edges.stride, current.rows, current.step},
                                          neighbourhood_,
                                          ratio_};
  const std::size_t parts = (rows + rows_at_once_ - 1) / rows_at_once_;
  if (is_grouped()) {
    kernel_(over(parts, local_size_), arguments, earlier.descriptors, earlier.edges.packed, current.descriptors,
            current.edges.packed, best_, similarity_);
  } else {
    transpose(earlier, earlier_blocks_);
    transpose(current, current_blocks_);
    blocks_kernel_(over(parts), arguments, earlier.descriptors, earlier_blocks_, earlier.edges.packed,
                   current.descriptors, current_blocks_, current.edges.packed, best_, similarity_);
  }
  std::vector<cl_int> best(rows);
  const opencl::CopyGuard guard(context_);
  best_.read_later(best.data(), rows);
  const auto similarity = similarity_.read(rows);
  TemporalMatches matches;
  for (std::size_t row = 0; row < rows; ++row) {
    if (best[row] < 0) continue;
    matches.append(static_cast<std::int32_t>(row) * earlier.step, best[row] * current.step, current_edges,
                   similarity[row], 0);
  }
  return matches;
}

}  // namespace quadedge::stages
