#pragma once
/// \file hash.hpp  Counter-based random numbers: a value depends only on its key, not on the order of evaluation.

#include <cmath>
#include <cstdint>

namespace quadedge::synthetic {

/// Finaliser of SplitMix64: a bijection in which every input bit affects about half of the output bits.
inline std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// Key of a pair; can be nested for longer keys.
inline std::uint64_t combine(std::uint64_t key, std::int64_t index) {
  return mix(key ^ mix(static_cast<std::uint64_t>(index)));
}

/// Uniform in the open interval (0, 1).
inline double uniform(std::uint64_t bits) { return (static_cast<double>(bits >> 11) + 0.5) * 0x1p-53; }

/// Standard normal deviate of a key (Box-Muller).
inline double normal(std::uint64_t key) {
  constexpr double kTwoPi = 6.283185307179586;
  return std::sqrt(-2.0 * std::log(uniform(mix(key)))) * std::cos(kTwoPi * uniform(mix(~key)));
}

/// A sequence of deviates for building a scene.
class Random {
 public:
  explicit Random(std::uint64_t key) : key_(key) {}
  double operator()(double low, double high) { return low + (high - low) * uniform(combine(key_, count_++)); }

 private:
  std::uint64_t key_;
  std::int64_t count_ = 0;
};

}  // namespace quadedge::synthetic
