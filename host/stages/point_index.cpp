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
  opencl::Defines defines = variant.defines;
  defines["GROUP"] = std::to_string(variant.local_size);
  kernel_ = {context, context.program({"indexed_points.cl", "point_index.cl"}, defines), "point_index"};
}

void PointIndex::run(const PositionsView& left_edges, const PositionsView& right_edges, DevicePointIndex& left,
                     DevicePointIndex& right) {
  context_.begin_stage("point_index");
  left.resize(context_, left_edges.at.count);
  right.resize(context_, right_edges.at.count);
  constexpr std::size_t kSideCount = 2;
  kernel_({kSideCount * local_size_, local_size_}, {left_edges.at, right_edges.at, left.layout(), right.layout()},
          left_edges.packed, right_edges.packed, left.points, left.cells, right.points, right.cells);
}

}  // namespace quadedge::stages
