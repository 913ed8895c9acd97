#include "stages/point_index.hpp"

#include "opencl/variants.hpp"

namespace quadedge::stages {

DevicePointIndex::DevicePointIndex(int width, int height) {
  layout_.columns = static_cast<int>((static_cast<float>(width) + kCellWidth - 1) / kCellWidth);
  layout_.rows = static_cast<int>((static_cast<float>(height) + kCellHeight - 1) / kCellHeight);
}

void DevicePointIndex::resize(opencl::Context& context, int count) {
  layout_.points = {0, count, count};
  points.ensure(context, 3 * static_cast<std::size_t>(count));
  cells.ensure(context, static_cast<std::size_t>(layout_.columns * layout_.rows + 1 + count));
}

PointIndex::PointIndex(opencl::Context& context, const std::map<std::string, std::string>& variants)
    : context_(context) {
  const auto& variant = opencl::choose_variant("point_index", context, variants);
  local_size_ = static_cast<std::size_t>(variant.local_size);
  grouped_ = variant.form == opencl::Form::groups;
  const auto program = variant.program(context);
  if (!grouped_) {
    kernel_ = {context, program, "point_index"};
    return;
  }
  scan_ = Scan(context, variants);
  count_ = {context, program, "point_index_count"};
  place_ = {context, program, "point_index_place"};
  sort_ = {context, program, "point_index_sort"};
}

void PointIndex::run(const PositionsView& left_edges, const PositionsView& right_edges, DevicePointIndex& left,
                     DevicePointIndex& right) {
  context_.begin_stage("point_index");
  left.resize(context_, left_edges.at.count);
  right.resize(context_, right_edges.at.count);
  const PointIndexArguments arguments{left_edges.at, right_edges.at, left.layout(), right.layout()};
  if (grouped_) {
    run_in_groups(arguments, left_edges, right_edges, left, right);
    return;
  }
  constexpr std::size_t kSideCount = 2;
  kernel_({kSideCount, local_size_}, arguments, left_edges.packed, right_edges.packed, left.points, left.cells,
          right.points, right.cells);
}

void PointIndex::run_in_groups(const PointIndexArguments& arguments, const PositionsView& left_edges,
                               const PositionsView& right_edges, DevicePointIndex& left, DevicePointIndex& right) {
  const int cells = left.cell_count() + right.cell_count(), edges = left_edges.at.count + right_edges.at.count;
  const auto cell_items = static_cast<std::size_t>(cells), edge_items = static_cast<std::size_t>(edges);
  counts_.ensure(context_, cell_items);
  numbers_.ensure(context_, edge_items);
  counts_.fill(0, cell_items);
  count_({edge_items, local_size_}, arguments, left_edges.packed, right_edges.packed, counts_);
  scan_.run(counts_, cells, edges, first_, total_);
  place_({edge_items, local_size_}, arguments, left_edges.packed, right_edges.packed, first_, counts_, numbers_);
  sort_({cell_items, local_size_}, arguments, left_edges.packed, right_edges.packed, first_, numbers_, left.points,
        left.cells, right.points, right.cells);
}

}  // namespace quadedge::stages
