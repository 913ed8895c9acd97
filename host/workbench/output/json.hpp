#pragma once
/// \file json.hpp  The machine-readable results of runs, localisations and trajectories (doc/design.md section 10). All
/// functions return the text of a JSON document.

#include <optional>
#include <string>
#include <vector>

#include "output/motion_errors.hpp"
#include "output/run_record.hpp"
#include "quadedge/localiser.hpp"

namespace quadedge::report {

/// Version of report.json; incremented when a key changes its meaning.
constexpr int kReportSchema = 1;

/// report.json of a run.
std::string report_json(const RunRecord& run);

/// Result of `evaluate trajectory`: the accuracy of report.json with the errors of every pose, and, if they were
/// judged, the steps.
std::string evaluation_json(const TrajectoryEvaluation& evaluation, const std::string& estimate,
                            const std::string& truth, const std::string& command,
                            const std::optional<evaluation::StepJudgement>& steps = std::nullopt);

/// One localisation of a recording.
struct LocalisationRecord {
  std::string command;      ///< its command line
  std::string ended_early;  ///< as in RunRecord
  std::string map_file;
  std::size_t key_rigs = 0;  ///< of the map
  InputFacts input;
  DeviceInfo device;
  Config config;  ///< effective
  std::vector<Localisation> frames;
  std::string truth_file;                        ///< empty without ground truth
  std::optional<TrajectoryEvaluation> accuracy;  ///< only with ground truth

  int located() const {
    int count = 0;
    for (const auto& frame : frames) count += frame.status == LocalisationStatus::located ? 1 : 0;
    return count;
  }
};

/// Why frames were lost: "5 unknown place, 2 ambiguous"; empty if there are none.
std::string lost_reasons(const std::vector<Localisation>& frames);

/// Median time per frame, except the first, which warms up [ms].
double median_latency_ms(const std::vector<Localisation>& frames);

/// localisation.json.
std::string localisation_json(const LocalisationRecord& record);

}  // namespace quadedge::report
