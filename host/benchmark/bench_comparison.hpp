#pragma once
/// \file bench_comparison.hpp  Two results of `quadedge bench`, figure by figure.

#include <string>
#include <vector>

namespace quadedge::bench {

/// Exit code of a comparison that finds a regression; follows the codes of ExitCode.
constexpr int kRegressionExitCode = 6;

/// One figure of both results. Smaller is better.
struct ComparedFigure {
  std::string name;  ///< with its unit
  double before = 0, after = 0;
  double change_percent = 0;  ///< of `after`; times are corrected for the machine's drift; NaN if `before` is zero
  bool judged = false;        ///< false for start-up times and stages below 5 % of the frame, which are only shown
  bool worse = false;         ///< judged, and worse by more than the noise band
};

/// All figures of two results.
struct BenchComparison {
  std::vector<ComparedFigure> figures;
  std::vector<std::string> notes;  ///< other differences: commit, configuration, variants, command
  double drift = 1;  ///< slowdown of the machine for the newer result, from both SIFT baselines; 1 if one is missing
  bool has_yardsticks = false;  ///< in both results; otherwise times are not corrected for the machine's drift
  bool regressed() const;
};

/// Compares two results. `noise_percent`: a judged figure up to this much larger counts as equal. Any newly lost frame
/// is a regression. \throws DataError, naming the file, if a file cannot be read, is not a result of `quadedge bench`,
/// or was measured on another device or input.
BenchComparison compare_benchmarks(const std::string& old_file, const std::string& new_file, double noise_percent);

}  // namespace quadedge::bench
