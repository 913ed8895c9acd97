/// \file paper_quads.cpp  Counts the quads of every row, then writes them; the host reads them block by block.
#include "device/paper_quads.hpp"

#include <algorithm>
#include <limits>

namespace quadedge::stages {

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
  const auto living = [&](const DevicePaperClusters& clusters) {
    const auto counts = clusters.count.read(rows);
    return static_cast<int>(std::count_if(counts.begin(), counts.end(), [](cl_int n) { return n > 0; }));
  };
  matches.alive_left = living(left.clusters);
  matches.alive_right = living(right.clusters);
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
