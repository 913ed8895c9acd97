#pragma once
/// \file temporal_match.hpp  Stage 6 in one kernel: from predicted positions to quads, without SIFT and without lists.

#include <map>
#include <optional>
#include <string>

#include "common/filter_limits.hpp"
#include "common/temporal_search.hpp"
#include "opencl/argument_structs.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"
#include "stages/device_stereo_edges.hpp"
#include "stages/judged_candidates.hpp"
#include "stages/point_index.hpp"
#include "stages/scan.hpp"

namespace quadedge::stages {

/// Rows that kept a candidate in each image before the agreement.
struct AliveRows {
  int left = 0, right = 0;
};

/// A search as a tap sees it: every candidate within the radius in either image. Candidates rejected by the agreement
/// are marked in the left lists.
struct TappedMatch {
  JudgedCandidates left, right;
};

/// doc/method.md section 4 for searches without SIFT. Variants of the stage "temporal_match".
class TemporalMatch {
 public:
  TemporalMatch(opencl::Context& context, const TemporalConfig& config,
                const std::map<std::string, std::string>& variants);

  /// True if the variant is a fused kernel and the search does not use SIFT.
  bool serves(const TemporalSearch& search) const { return fused_ && temporal_limits(config_, search).sift_max == 0; }

  /// Builds the form for taps, from the same source, unless it exists.
  void prepare_tap();

  /// Matches and reads the rows back into `matches`; `edges` holds the current stereo edges on the host. `predicted`:
  /// the lists of the left and of the right image; `left` and `right`: the point indices of the current stereo edges.
  /// \param tapped where given, the kernel's tap form runs and shows its candidates; both rigs then need their SIFT
  /// descriptors. \returns nothing where a row has more candidates than the kernel has room for: then lists have to be
  /// used
  std::optional<AliveRows> run(const DevicePositions& predicted, const TemporalSearch& search,
                               const DeviceStereoEdges& base, const DeviceStereoEdges& current,
                               const DevicePointIndex& left, const DevicePointIndex& right, const StereoEdges& edges,
                               TemporalMatches& matches, TappedMatch* tapped = nullptr);

 private:
  template <class T>
  using In = opencl::In<T>;
  template <class T>
  using Out = opencl::Out<T>;

  /// The arguments of the production form, then those of the tap form.
  template <class... Tapped>
  using MatchKernel = opencl::Kernel<TemporalMatchArguments, In<cl_float>, In<cl_float>, In<cl_int>, In<cl_float>,
                                     In<cl_int>, In<cl_char>, In<cl_int>, In<cl_char>, In<cl_char>, In<cl_int>,
                                     In<cl_char>, In<cl_float>, Out<cl_int>, Tapped...>;

  void read_tapped(std::size_t rows, TappedMatch& tapped) const;
  /// Reads the rows of the result back. \returns nothing where a row has no room for its candidates
  std::optional<AliveRows> read_quads(std::size_t rows, int step, const StereoEdges& edges, TemporalMatches& matches);

  opencl::Context& context_;
  TemporalConfig config_;
  std::map<std::string, std::string> variants_;
  bool fused_;
  std::size_t local_size_, items_per_row_;
  opencl::Buffer<cl_int> result_;
  opencl::ReadBack read_back_;
  MatchKernel<> kernel_;

  /// Members for taps only.
  struct TapForm {
    Scan scan;
    opencl::Buffer<cl_int> counts, first, total, seen;
    MatchKernel<In<cl_int>, cl_int, Out<cl_int>, Out<cl_int>, In<cl_uchar>, In<cl_uchar>, In<cl_uchar>, In<cl_uchar>>
        kernel;
  };
  std::optional<TapForm> tap_;
};

}  // namespace quadedge::stages
