#include "report/report_tables.hpp"

#include "report/number_text.hpp"

namespace quadedge::report {
namespace {

constexpr std::size_t kErrorColumns = 10;

/// Cells of the four errors, mean and standard deviation each; `baseline` may be null.
void add_errors(std::vector<std::string>& row, const SummaryAccuracy& accuracy, const SummaryAccuracy* baseline,
                PoseErrors SummaryAccuracy::*alignment) {
  for (const auto error : {&PoseErrors::ape_rotation_deg, &PoseErrors::ape_translation_m, &PoseErrors::rpe_rotation_deg,
                           &PoseErrors::rpe_translation_m}) {
    const ErrorStatistics& value = (accuracy.*alignment).*error;
    for (const auto number : {&ErrorStatistics::mean, &ErrorStatistics::std}) {
      row.push_back(baseline == nullptr
                        ? significant(value.*number)
                        : with_difference(value.*number, ((baseline->*alignment).*error).*number, "\n"));
    }
  }
}

const SummaryAccuracy* baseline_accuracy(const SequenceResults& sequence) {
  return sequence.baseline && sequence.baseline->accuracy ? &*sequence.baseline->accuracy : nullptr;
}

/// The row of everything together. A baseline is compared where it has all of the sequences alone.
std::vector<std::string> row_over_all(const std::vector<SequenceResults>& sequences,
                                      PoseErrors SummaryAccuracy::*alignment) {
  std::vector<const SummaryAccuracy*> own, other;
  for (const auto& sequence : sequences) {
    if (!sequence.row.accuracy) continue;
    own.push_back(&*sequence.row.accuracy);
    if (const auto* baseline = baseline_accuracy(sequence)) other.push_back(baseline);
  }
  const auto total = pooled_accuracy(own);
  const auto compared = other.size() == own.size() ? pooled_accuracy(other) : std::nullopt;
  std::vector<std::string> row = {"all, every pose counts the same", total ? std::to_string(total->matched) : "-"};
  if (total) add_errors(row, *total, compared ? &*compared : nullptr, alignment);
  row.resize(kErrorColumns, "-");
  return row;
}

std::vector<std::string> peer_over_all(const std::vector<SequenceResults>& sequences, const Peer& peer,
                                       PoseErrors SummaryAccuracy::*alignment) {
  std::vector<SummaryAccuracy> parts;
  for (const auto& sequence : sequences) {
    for (const auto& trajectory : sequence.trajectories) {
      const auto accuracy = trajectory.accuracy();
      if (trajectory.name == peer.name && accuracy) parts.push_back(*accuracy);
    }
  }
  std::vector<const SummaryAccuracy*> pointers;
  for (const auto& part : parts) pointers.push_back(&part);
  const auto total = pooled_accuracy(pointers);
  std::vector<std::string> row = {peer.name + " over its " + std::to_string(parts.size()) + " sequences",
                                  total ? std::to_string(total->matched) : "-"};
  if (total) add_errors(row, *total, nullptr, alignment);
  row.resize(kErrorColumns, "-");
  return row;
}

}  // namespace

HtmlTable error_table(const std::vector<SequenceResults>& sequences, const std::vector<Peer>& peers,
                      PoseErrors SummaryAccuracy::*alignment, const std::string& caption) {
  HtmlTable table;
  table.caption = caption;
  table.groups = {{"", 1}, {"", 1}, {"APE_R [deg]", 2}, {"APE_T [m]", 2}, {"RPE_R [deg]", 2}, {"RPE_T [m]", 2}};
  table.columns = {"sequence", "poses", "mean", "std", "mean", "std", "mean", "std", "mean", "std"};
  for (const auto& sequence : sequences) {
    std::vector<std::string> row = {sequence.row.member.name, "-"};
    if (const auto& accuracy = sequence.row.accuracy) {
      row[1] = std::to_string(accuracy->matched);
      add_errors(row, *accuracy, baseline_accuracy(sequence), alignment);
    }
    row.resize(kErrorColumns, "-");
    table.rows.push_back(row);
    for (const auto& trajectory : sequence.trajectories) {
      bool is_peer = false;
      for (const auto& peer : peers) is_peer = is_peer || peer.name == trajectory.name;
      const auto accuracy = trajectory.accuracy();
      if (!is_peer || !accuracy) continue;
      std::vector<std::string> peer_row = {"\u2003" + trajectory.name, std::to_string(accuracy->matched)};
      add_errors(peer_row, *accuracy, nullptr, alignment);
      table.rows.push_back(peer_row);
    }
  }
  for (const auto& peer : peers) table.rows.push_back(peer_over_all(sequences, peer, alignment));
  table.rows.push_back(row_over_all(sequences, alignment));
  table.last_row_counts = true;
  return table;
}

HtmlTable latency_table(const std::vector<SequenceResults>& sequences) {
  HtmlTable table;
  table.caption = "Tracked frames and latency";
  table.groups = {{"", 1}, {"", 1}, {"frames", 1}, {"key stereo", 1}, {"latency [ms]", 5}};
  table.columns = {"sequence", "outcome", "tracked", "rigs", "median", "p90", "p99", "max", "first frame"};
  for (const auto& sequence : sequences) {
    const SummaryRow& own = sequence.row;
    std::vector<std::string> row = {own.member.name, to_string(own.status)};
    if (sequence.ran()) {
      row.push_back(share_text(own.tracked, own.frames));
      if (sequence.baseline && sequence.baseline->tracked != own.tracked) {
        const int more = own.tracked - sequence.baseline->tracked;
        row.back() += " (" + std::string(more > 0 ? "+" : "") + std::to_string(more) + ")";
      }
      row.push_back(std::to_string(own.key_rigs));
      for (const auto value : {&LatencySummary::median, &LatencySummary::p90, &LatencySummary::p99,
                               &LatencySummary::max, &LatencySummary::first}) {
        row.push_back(sequence.baseline ? with_difference(own.latency.*value, sequence.baseline->latency.*value)
                                        : significant(own.latency.*value));
      }
    }
    row.resize(table.columns.size(), "-");
    table.rows.push_back(row);
  }
  return table;
}

}  // namespace quadedge::report
