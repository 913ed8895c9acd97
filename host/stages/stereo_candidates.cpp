#include "stages/stereo_candidates.hpp"

#include "opencl/variants.hpp"

namespace quadedge::stages {
namespace {

constexpr int kFirstCapacityPerEdge = 24;  // initial; grows as needed

}  // namespace

StereoCandidates::StereoCandidates(opencl::Context& context, const std::map<std::string, std::string>& variants)
    : context_(context), scan_(context, variants) {
  const auto& variant = opencl::choose_variant("stereo_candidates", context, variants);
  local_size_ = static_cast<std::size_t>(variant.local_size);
  const auto program = variant.program(context);
  count_ = {context, program, "stereo_candidates_count"};
  fill_ = {context, program, "stereo_candidates_fill"};
}

void StereoCandidates::run(const DeviceEdges& left, const DeviceEdges& right, int right_height,
                           const EpipolarGeometry& geometry, const DisparityProbe& probe,
                           DeviceCandidates& candidates) {
  context_.begin_stage("stereo_candidates");
  candidates.rows = left.host_count;
  candidates.counts.ensure(context_, static_cast<std::size_t>(left.host_count));
  noted_.ensure(context_, kNotedCandidates * static_cast<std::size_t>(left.host_count));
  listed_.ensure(context_, static_cast<std::size_t>(right.host_count));
  candidates.reserve(context_, kFirstCapacityPerEdge * left.host_count);
  const opencl::Range range(static_cast<std::size_t>(left.host_count), local_size_);
  const StereoCandidateArguments arguments{left.positions().at, right.positions().at, right_height, geometry, probe};
  count_(range, arguments, left.packed, right.packed, right.row_first, candidates.counts, noted_, listed_);
  candidates.build(context_, scan_, [&] {
    fill_(range, arguments, left.packed, right.packed, right.row_first, candidates.first, candidates.capacity, noted_,
          candidates.target, listed_);
  });
}

}  // namespace quadedge::stages
