#pragma once
/// \file bench_comparison.hpp  Two results of `quadedge bench`, figure by figure.

#include <string>
#include <vector>

namespace quadedge::bench {

/// Exit code of a comparison that finds a regression; the codes of ExitCode go before it.
constexpr int kRegressionExitCode = 6;

/// One figure of both results. Smaller is better.
struct ComparedFigure {
  std::string name;  ///< with its unit
  double before = 0, after = 0;
  double change_percent =
      0;                ///< of `after`, freed from the machine's drift for a time; NaN where there was nothing before
  bool judged = false;  ///< whether it counts: times of start-up and of stages below 5 % of the frame are shown alone
  bool worse = false;   ///< judged, and worse beyond the noise band
};

/// All figures of two results.
struct BenchComparison {
  std::vector<ComparedFigure> figures;
  std::vector<std::string> notes;  ///< what else differs: commit, configuration, variants, command
  double drift = 1;  ///< how much slower the machine was for the newer result, by SIFT of both; 1 where one lacks it
  bool has_yardsticks = false;  ///< both results; without, times are those of two moments of the machine
  bool regressed() const;
};

/// Compares two results. `noise_percent`: a judged figure may be so much larger and still count as equal. Frames lost
/// that were tracked before are a regression whatever their number. \throws DataError, naming the file, for one that
/// cannot be read, is no result of `quadedge bench`, or was measured on another device or input than the other.
BenchComparison compare_benchmarks(const std::string& old_file, const std::string& new_file, double noise_percent);

}  // namespace quadedge::bench
