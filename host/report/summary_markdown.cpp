/// \file summary_markdown.cpp  summary.md of a batch: tables to read and to paste.
#include "data/text.hpp"
#include "report/batch_summary.hpp"
#include "report/number_text.hpp"

namespace quadedge::report {
namespace {

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '|' || c == '*' || c == '\\' || c == '`' || c == '<') result += '\\';
    result += c == '\n' ? ' ' : c;
  }
  return result;
}

std::string error_cells(const PoseErrors& errors) {
  std::string cells;
  for (const auto* error :
       {&errors.ape_rotation_deg, &errors.ape_translation_m, &errors.rpe_rotation_deg, &errors.rpe_translation_m}) {
    cells += " " + significant(error->mean) + " | " + significant(error->std) + " |";
  }
  return cells;
}

/// One table of errors with the columns of the paper's Table 4.
std::string error_table(const BatchSummary& summary, PoseErrors TrajectoryEvaluation::*alignment) {
  std::string text =
      "| sequence | APE_R (deg) mean | std | APE_T (m) mean | std | RPE_R (deg) mean | std | RPE_T (m) mean | std |\n"
      "|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& row : summary.rows) {
    if (row.accuracy) text += "| " + escaped(row.member.name) + " |" + error_cells((*row.accuracy).*alignment) + "\n";
  }
  text += "| **all, every pose counts the same** |" + error_cells((*summary.pooled).*alignment) + "\n";
  text += "| **all, every sequence counts the same** |" + error_cells((*summary.average).*alignment) + "\n";
  return text;
}

std::string latency_cells(const LatencySummary& latency) {
  std::string cells;
  for (const double value : {latency.median, latency.p90, latency.p99, latency.max, latency.first}) {
    cells += " " + significant(value) + " |";
  }
  return cells;
}

}  // namespace

std::string summary_markdown(const BatchSummary& summary) {
  std::string text = "# QuadEdge " QUADEDGE_VERSION ", " + data::counted(summary.rows.size(), "sequence") + "\n";
  std::string failures;
  bool shared = false;
  for (const auto& row : summary.rows) {
    shared = shared || row.member.jobs > 1;
    if (row.status == MemberStatus::done) continue;
    failures += "| " + escaped(row.member.name) + " | " + to_string(row.status) + " | " +
                std::to_string(row.member.exit_code) + " | " + escaped(row.member.message) + " |\n";
  }
  if (!failures.empty()) {
    text += "\n## Sequences that did not end well\n\n| sequence | status | exit code | message |\n|---|---|---|---|\n" +
            failures;
  }
  if (summary.pooled) {
    text += "\n## Errors, origin-aligned (the paper's Table 4)\n\nThe first compared poses are made equal.\n\n" +
            error_table(summary, &TrajectoryEvaluation::origin_aligned);
    text +=
        "\n## Errors, SE(3)-aligned\n\nThe whole trajectory is moved onto the ground truth (least squares over all "
        "positions, no "
        "scale), as other systems often quote.\n\n" +
        error_table(summary, &TrajectoryEvaluation::se3_aligned);
  }
  text += "\n## Tracked frames and latency\n\nLatency in milliseconds, from both images in host memory to the pose.";
  if (shared) text += " Several sequences ran at the same time, so latencies are longer than those of a lone run.";
  text += "\n\n| sequence | tracked | median | p90 | p99 | max | first frame |\n|---|---|---|---|---|---|---|\n";
  for (const auto& row : summary.rows) {
    text += "| " + escaped(row.member.name) + " | " + share_text(row.tracked, row.frames) + " |" +
            latency_cells(row.latency) + "\n";
  }
  text += "| **all** | " + share_text(summary.tracked, summary.frames) + " |" + latency_cells(summary.latency) + "\n";
  std::string broken;
  for (const auto& row : summary.rows) {
    if (row.segments > 1)
      broken += (broken.empty() ? "" : ", ") + escaped(row.member.name) + " " + std::to_string(row.segments);
  }
  if (!broken.empty()) text += "\nSequences of several segments, with unknown motions between them: " + broken + ".\n";
  return text;
}

}  // namespace quadedge::report
