#pragma once
/// \file json.hpp  The machine-readable results (doc/design.md section 10). All functions return the text of a JSON
/// document.

#include <optional>
#include <string>

#include "evaluation/step_judgement.hpp"
#include "report/run_record.hpp"

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

/// Chrome's trace format (chrome://tracing, ui.perfetto.dev): one event per frame, with its stages one after another
/// inside it.
std::string trace_json(const RunRecord& run);

}  // namespace quadedge::report
