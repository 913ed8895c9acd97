#include "report/comparison.hpp"

#include <filesystem>
#include <optional>

#include "quadedge/error.hpp"
#include "quadedge/evaluation.hpp"
#include "quadedge/trajectory.hpp"
#include "report/batch_summary.hpp"
#include "report/json_values.hpp"

namespace quadedge::report {
namespace fs = std::filesystem;
namespace {

const std::string kBaseline = "baseline";

bool ran(const SummaryRow& row) {
  return row.status == MemberStatus::done || row.status == MemberStatus::too_few_tracked;
}

/// The file of a peer's trajectory; empty if there is none.
std::string peer_file(const Peer& peer, const std::string& name) {
  const fs::path folder(name), of_batch = fs::path("sequences") / name;
  for (const fs::path& file : {fs::path(name + ".txt"), folder / "trajectory.txt", of_batch / "trajectory.txt"}) {
    std::error_code ignored;
    if (fs::is_regular_file(fs::path(peer.folder) / file, ignored)) return (fs::path(peer.folder) / file).string();
  }
  return {};
}

Json per_pose(const TrajectoryEvaluation& evaluation) {
  Json columns = {{"stamp_s", Json::array()},
                  {"ape_rotation_deg", Json::array()},
                  {"ape_translation_m", Json::array()},
                  {"rpe_rotation_deg", Json::array()},
                  {"rpe_translation_m", Json::array()}};
  for (const auto& pose : evaluation.per_pose) {
    columns["stamp_s"].push_back(1e-9 * static_cast<double>(pose.stamp_ns));
    columns["ape_rotation_deg"].push_back(to_json(pose.ape_rotation_deg));
    columns["ape_translation_m"].push_back(to_json(pose.ape_translation_m));
    columns["rpe_rotation_deg"].push_back(to_json(pose.rpe_rotation_deg));
    columns["rpe_translation_m"].push_back(to_json(pose.rpe_translation_m));
  }
  return columns;
}

/// The comparison of one batch as it grows.
class Comparison {
 public:
  explicit Comparison(Json& sequences) : sequences_(sequences) {}

  void add(const std::string& output, const std::string& name, double min_tracked, const std::string& baseline,
           const std::vector<Peer>& peers) {
    entry_ = {{"name", name}, {"systems", Json::array()}, {"notes", Json::array()}};
    const SummaryRow own = read_summary_row(member_folder(output, name), name, min_tracked);
    if (ran(own)) {
      own_with_truth_ += own.accuracy ? 1 : 0;
      compare(member_folder(output, name), name, min_tracked, baseline, peers);
    }
    sequences_.push_back(std::move(entry_));
  }

  /// Of a system over its sequences; nothing for a baseline that lacks some.
  Json over_all(const std::string& system) const {
    std::vector<const TrajectoryEvaluation*> parts;
    for (const auto& [name, accuracy] : accuracies_) {
      if (name == system) parts.push_back(&accuracy);
    }
    const auto pooled = pooled_accuracy(parts);
    if (!pooled || (system == kBaseline && parts.size() != own_with_truth_)) return nullptr;
    return {{"name", system}, {"sequences", parts.size()}, {"accuracy", to_json(*pooled)}};
  }

 private:
  void compare(const std::string& folder, const std::string& name, double min_tracked, const std::string& baseline,
               const std::vector<Peer>& peers) {
    Trajectory truth;
    try {
      if (fs::is_regular_file(folder + "/groundtruth.txt")) truth = read_tum(folder + "/groundtruth.txt");
    } catch (const DataError& problem) {
      return note(problem.what());
    }
    if (!baseline.empty()) {
      const std::string other = member_folder(baseline, name);
      const SummaryRow row = read_summary_row(other, name, min_tracked);
      if (ran(row) && add_system(kBaseline, other + "/trajectory.txt", truth)) {
        entry_["baseline"] = {
            {"frames", row.frames}, {"frames_tracked", row.tracked}, {"latency_ms", to_json(row.latency)}};
        if (row.accuracy) {
          entry_["baseline"]["accuracy"] = to_json(*row.accuracy);
          accuracies_.emplace_back(kBaseline, *row.accuracy);
        }
      }
    }
    for (const auto& peer : peers) {
      const std::string file = peer_file(peer, name);
      if (file.empty()) {
        note(peer.name + ": no " + name + ".txt in " + peer.folder);
      } else {
        add_system(peer.name, file, truth);
      }
    }
  }

  /// False if the file cannot be read; a note states why.
  bool add_system(const std::string& system, const std::string& file, const Trajectory& truth) {
    Trajectory poses;
    try {
      poses = read_tum(file);
    } catch (const DataError& problem) {
      note(system + ": " + problem.what());
      return false;
    }
    Json json = {{"name", system}, {"file", fs::absolute(file).string()}};
    try {
      if (!truth.empty()) {
        TrajectoryEvaluation evaluation = evaluate_trajectory(poses, truth);
        json["accuracy"] = to_json(evaluation);
        json["per_pose"] = per_pose(evaluation);
        if (system != kBaseline) accuracies_.emplace_back(system, std::move(evaluation));
      }
    } catch (const DataError& problem) {
      note(system + ": " + problem.what());
    }
    entry_["systems"].push_back(std::move(json));
    return true;
  }

  void note(const std::string& text) { entry_["notes"].push_back(text); }

  Json& sequences_;
  Json entry_;
  std::vector<std::pair<std::string, TrajectoryEvaluation>> accuracies_;  ///< with the system's name
  std::size_t own_with_truth_ = 0;
};

}  // namespace

std::string comparison_json(const std::string& output, const std::string& baseline, const std::vector<Peer>& peers,
                            const std::string& command) {
  const SummarisedBatch batch = summarised_batch(output);
  if (!baseline.empty()) summarised_batch(baseline);  // throws for a folder without a batch
  Json json;
  json["schema"] = kComparisonSchema;
  add_origin(json, command);
  json["batch"] = output;
  json["baseline"] = baseline.empty() ? Json(nullptr) : Json(baseline);
  json["peers"] = Json::array();
  for (const auto& peer : peers) json["peers"].push_back({{"name", peer.name}, {"folder", peer.folder}});
  json["sequences"] = Json::array();
  Comparison comparison(json["sequences"]);
  for (const auto& name : batch.names) comparison.add(output, name, batch.min_tracked, baseline, peers);
  json["all"] = Json::array();
  if (const Json all = comparison.over_all(kBaseline); !all.is_null()) json["all"].push_back(all);
  for (const auto& peer : peers) {
    if (const Json all = comparison.over_all(peer.name); !all.is_null()) json["all"].push_back(all);
  }
  return json_text(json);
}

}  // namespace quadedge::report
