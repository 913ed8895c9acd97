#include "stages/device_candidates.hpp"

namespace quadedge::stages {

CandidateLists DeviceCandidates::read() const {
  CandidateLists lists;
  lists.first = first.read(static_cast<std::size_t>(rows) + 1);
  lists.target = target.read(static_cast<std::size_t>(host_total));
  return lists;
}

JudgedCandidates DeviceCandidates::read_judged() const {
  const auto size = static_cast<std::size_t>(host_total);
  return {first.read(static_cast<std::size_t>(rows) + 1), target.read(size), state.read(size), ncc.read(size),
          sift.read(size)};
}

}  // namespace quadedge::stages
