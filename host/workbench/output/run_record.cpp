/// \file run_record.cpp  Medians and percentiles over the frames after the first, which pays for warming up.
#include "output/run_record.hpp"

#include <limits>

#include "output/statistics.hpp"

namespace quadedge::report {
namespace {

/// The first frame has no frame before it and pays for warming up; it is left out of summaries unless it is the only
/// one.
std::size_t first_counted(std::size_t frames) { return frames > 1 ? 1 : 0; }

}  // namespace

LatencySummary latency_summary(const std::deque<FrameResult>& frames) {
  std::vector<double> values;
  for (const FrameResult& frame : frames) values.push_back(frame.timing.latency_ms);
  return latency_summary(values);
}

LatencySummary latency_summary(std::vector<double> values) {
  LatencySummary summary;
  summary.first = values.empty() ? std::numeric_limits<double>::quiet_NaN() : values.front();
  values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(first_counted(values.size())));
  summary.median = median(values);
  summary.p90 = percentile(values, 0.9);
  summary.p99 = percentile(values, 0.99);
  summary.max = percentile(values, 1.0);
  return summary;
}

std::vector<StageSummary> stage_summary(const std::vector<std::vector<StageTime>>& frames) {
  std::vector<std::string> names;
  for (const auto& stages : frames) {
    for (const auto& stage : stages) {
      if (std::find(names.begin(), names.end(), stage.stage) == names.end()) names.push_back(stage.stage);
    }
  }
  std::vector<StageSummary> summary;
  for (const auto& name : names) {
    std::vector<double> values;
    for (std::size_t i = first_counted(frames.size()); i < frames.size(); ++i) {
      double sum = 0;
      bool seen = false;
      for (const auto& stage : frames[i]) {
        if (stage.stage != name) continue;
        sum += stage.ms;
        seen = true;
      }
      if (seen) values.push_back(sum);
    }
    if (!values.empty()) summary.push_back({name, median(values), percentile(values, 0.9)});
  }
  return summary;
}

std::vector<std::vector<StageTime>> stage_times(const std::deque<FrameResult>& frames) {
  std::vector<std::vector<StageTime>> times;
  for (const auto& frame : frames) times.push_back(frame.timing.stages);
  return times;
}

std::string lost_reasons(const std::deque<FrameResult>& frames) {
  std::map<FrameStatus, int> counts;
  for (const auto& frame : frames) ++counts[frame.status];
  return lost_reasons(counts);
}

std::string joined(const std::vector<Warning>& warnings) {
  std::string text;
  for (const Warning& warning : warnings) text += (text.empty() ? "" : "; ") + warning.text;
  return text;
}

std::string segments_text(const std::deque<FrameResult>& frames) {
  constexpr std::size_t kMostNamed = 5;
  std::vector<std::string> breaks;
  std::optional<std::size_t> last;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!is_tracked(frames[i].status)) continue;
    if (last && frames[*last].segment != frames[i].segment)
      breaks.push_back("between frames " + std::to_string(*last) + " and " + std::to_string(i));
    last = i;
  }
  if (breaks.empty()) return {};
  std::string text = std::to_string(breaks.size() + 1) + " segments: an unknown motion lies ";
  const std::size_t named = std::min(breaks.size(), kMostNamed);
  for (std::size_t i = 0; i < named; ++i) text += (i == 0 ? "" : ", ") + breaks[i];
  return text + (named < breaks.size() ? ", and at " + std::to_string(breaks.size() - named) + " more places" : "");
}

double path_length_m(const std::deque<FrameResult>& frames) {
  double length = 0;
  const FrameResult* last = nullptr;
  for (const auto& frame : frames) {
    if (!frame.world_from_left) continue;
    if (last != nullptr && last->segment == frame.segment)
      length += (frame.world_from_left->translation() - last->world_from_left->translation()).norm();
    last = &frame;
  }
  return length;
}

std::vector<std::pair<std::string, int>> named_counts(const FrameCounts& counts) {
  return {{"edges_left", counts.edges_left},
          {"edges_right", counts.edges_right},
          {"stereo_edges", counts.stereo_edges},
          {"temporal_left", counts.temporal_left},
          {"temporal_right", counts.temporal_right},
          {"quads", counts.quads},
          {"inliers", counts.inliers}};
}

std::vector<std::pair<std::string, double>> count_medians(const std::deque<FrameResult>& frames) {
  std::vector<std::pair<std::string, double>> medians;
  for (const auto& [name, unused] : named_counts({})) {
    (void)unused;
    medians.emplace_back(name, 0.0);
  }
  for (std::size_t column = 0; column < medians.size(); ++column) {
    std::vector<double> values;
    for (std::size_t i = first_counted(frames.size()); i < frames.size(); ++i) {
      values.push_back(named_counts(frames[i].counts)[column].second);
    }
    medians[column].second = median(values);
  }
  return medians;
}

}  // namespace quadedge::report
