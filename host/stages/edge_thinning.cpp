#include "stages/edge_thinning.hpp"

namespace quadedge::stages {
EdgeThinning::EdgeThinning(opencl::Context& context, int height, int max_edges,
                           const std::map<std::string, std::string>& variants)
    : context_(context),
      height_(height),
      max_edges_(max_edges),
      local_size_(context.is_cpu() ? 1 : 64),
      scan_(context, variants) {
  const cl::Program program = context.program({"edge_thinning.cl"}, {});
  choose_ = {context, program, "edges_thinning_flags"};
  move_ = {context, program, "edges_thinning_move"};
  flags_.ensure(context, static_cast<std::size_t>(max_edges));
  counts_.ensure(context, 2 * static_cast<std::size_t>(height));
}

void EdgeThinning::run(const DeviceEdges& all, DeviceEdges& thinned) {
  context_.begin_stage("edge_thinning");
  thinned.reserve(context_, max_edges_);
  const opencl::Range rows(2 * static_cast<std::size_t>(height_), local_size_);
  choose_(rows, all.packed, all.stride, all.row_first, 2 * height_, flags_, counts_);
  scan_.run(counts_, 2 * height_, max_edges_, thinned.row_first, thinned.count);
  move_(rows, all.packed, all.stride, all.row_first, 2 * height_, flags_, thinned.row_first, thinned.packed);
  thinned.count.copy(all.count, 1, 1);
}

}  // namespace quadedge::stages
