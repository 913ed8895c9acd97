/// \file paper_clusters.cpp  Launches over the rows of a list; the host reads the clusters without gaps.
#include "device/paper_clusters.hpp"

#include <algorithm>
#include <limits>

#include "common/matching_constants.hpp"

namespace quadedge::stages {

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

}  // namespace quadedge::stages
