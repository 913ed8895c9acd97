#pragma once
/// \file filter_names.hpp  The filters of both cascades in their order, as the tables print them.

#include <array>

namespace quadedge {

/// Stereo cascade; the index is the order of the paper's Table 1 (doc/method.md section 3).
inline constexpr std::array<const char*, 11> kStereoFilters = {"baseline",
                                                               "epipolar proximity",
                                                               "limited disparity",
                                                               "orientation",
                                                               "SIFT",
                                                               "NCC",
                                                               "nearly best NCC",
                                                               "nearly best SIFT",
                                                               "refinement and clustering",
                                                               "likeness of representatives",
                                                               "best"};
inline constexpr int kStereoSiftOrder = 4, kStereoNccOrder = 5, kStereoRefinementOrder = 8;

/// Temporal cascade; the index is the order (doc/method.md section 4). Each kind of search takes SIFT where its limit
/// is set (temporal_limits()).
inline constexpr std::array<const char*, 9> kTemporalFilters = {
    "baseline",        "displacement",     "orientation",    "NCC", "SIFT",
    "nearly best NCC", "nearly best SIFT", "quad agreement", "best"};
inline constexpr int kTemporalNccOrder = 3, kTemporalSiftOrder = 4, kAgreementOrder = 7;

}  // namespace quadedge
