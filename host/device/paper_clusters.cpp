/// \file paper_clusters.cpp  Launches over the rows of a list; the host reads the clusters without gaps.
#include "device/paper_clusters.hpp"

#include "common/matching_constants.hpp"

namespace quadedge::stages {

PaperClusters::PaperClusters(opencl::Context& context, const opencl::VariantChoice& variants, int max_value)
    : Stage(context, "paper_clusters", variants) {
  const auto program = variant_.program(context, image_defines(max_value));
  cluster_ = {context, program, "paper_clusters"};
  compare_ = {context, program, "paper_similarity"};
}

void PaperClusters::cluster(const PositionsView& moving, const DeviceCandidates& candidates,
                            const opencl::Buffer<cl_float>& refined, DevicePaperClusters& clusters) {
  begin();
  const auto capacity = static_cast<std::size_t>(candidates.capacity), rows = static_cast<std::size_t>(candidates.rows);
  clusters.stride = candidates.capacity;
  clusters.scratch.ensure(context_, 2 * capacity);
  clusters.count.ensure(context_, rows);
  clusters.packed.ensure(context_, 4 * capacity);
  clusters.member_first.ensure(context_, 2 * capacity);
  clusters.members.ensure(context_, capacity);
  if (rows == 0) return;
  const PaperClusterArguments arguments{moving.at,
                                        candidates.rows,
                                        candidates.capacity,
                                        static_cast<float>(kClusterGap),
                                        static_cast<float>(kClusterOrientation),
                                        kClusterSizeMax,
                                        static_cast<float>(kClusterSigma)};
  cluster_(over(rows), arguments, candidates.first, candidates.target, candidates.state, moving.packed, refined,
           clusters.scratch, clusters.count, clusters.packed, clusters.member_first, clusters.members);
}

void PaperClusters::compare(const DevicePicture& right, const opencl::Buffer<cl_float>& left_patches, double offset,
                            double ncc_min, const DeviceCandidates& candidates, DevicePaperClusters& clusters) {
  begin();
  const auto rows = static_cast<std::size_t>(candidates.rows);
  clusters.chosen.ensure(context_, rows);
  if (rows == 0) return;
  const PaperSimilarityArguments arguments{candidates.rows, candidates.capacity,        right.width,
                                           right.height,    static_cast<float>(offset), static_cast<float>(ncc_min)};
  compare_(over(rows), arguments, candidates.first, clusters.count, right.records, left_patches, clusters.packed,
           clusters.chosen);
}

DevicePaperClusters::Lists DevicePaperClusters::read(const DeviceCandidates& candidates, bool compared) const {
  const auto rows = static_cast<std::size_t>(candidates.rows), size = static_cast<std::size_t>(stride);
  const auto from = candidates.first.read(rows + 1), counts = count.read(rows);
  const auto values = packed.read(4 * size);
  const auto starts = member_first.read(2 * size), targets = members.read(size);
  Lists lists;
  lists.first.push_back(0);
  lists.member_first.push_back(0);
  if (compared) lists.chosen = chosen.read(rows);
  for (std::size_t i = 0; i < rows; ++i) {
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
