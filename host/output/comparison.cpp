/// \file comparison.cpp  Evaluates the trajectory of every system on the ground truth that the batch has kept.
#include "output/comparison.hpp"

#include <filesystem>
#include <map>

#include "output/json_values.hpp"
#include "quadedge/error.hpp"
#include "quadedge/evaluation.hpp"
#include "quadedge/trajectory.hpp"

namespace quadedge::report {
namespace fs = std::filesystem;
namespace {

/// What OUT/summary.json states about the batch in OUT. \throws DataError for a missing or damaged file.
Json read_summary(const std::string& output) { return read_json(output + "/summary.json", "the summary of a batch"); }

bool ran(const Json& entry) { return entry.contains("frames_tracked"); }

std::string member_folder(const std::string& output, const std::string& name) {
  return (fs::path(output) / "sequences" / name).string();
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

/// The comparison of one sequence as it grows.
class Comparison {
 public:
  explicit Comparison(const std::string& name)
      : entry_({{"name", name}, {"systems", Json::array()}, {"notes", Json::array()}}) {}

  /// `folder`: results of the sequence; `baseline`: folder of the other batch, with its `entry`, or empty.
  Json compare(const std::string& folder, const std::string& name, const std::string& baseline, const Json& entry,
               const std::vector<Peer>& peers) {
    try {
      if (fs::is_regular_file(folder + "/groundtruth.txt")) truth_ = read_tum(folder + "/groundtruth.txt");
    } catch (const DataError& problem) {
      note(problem.what());
      return std::move(entry_);
    }
    if (ran(entry) && add_system("baseline", member_folder(baseline, name) + "/trajectory.txt")) {
      for (const char* key : {"frames", "frames_tracked", "latency_ms", "accuracy"})
        if (entry.contains(key)) entry_["baseline"][key] = entry[key];
    }
    for (const auto& peer : peers) {
      const std::string file = peer_file(peer, name);
      if (file.empty()) {
        note(peer.name + ": no " + name + ".txt in " + peer.folder);
      } else {
        add_system(peer.name, file);
      }
    }
    return std::move(entry_);
  }

  /// Of a sequence without results.
  Json nothing() { return std::move(entry_); }

 private:
  /// False if the file cannot be read; a note states why.
  bool add_system(const std::string& system, const std::string& file) {
    Trajectory poses;
    try {
      poses = read_tum(file);
    } catch (const DataError& problem) {
      note(system + ": " + problem.what());
      return false;
    }
    Json json = {{"name", system}, {"file", fs::absolute(file).string()}};
    try {
      if (!truth_.empty()) {
        const TrajectoryEvaluation evaluation = evaluate_trajectory(poses, truth_);
        json["accuracy"] = to_json(evaluation);
        json["per_pose"] = per_pose(evaluation);
      }
    } catch (const DataError& problem) {
      note(system + ": " + problem.what());
    }
    entry_["systems"].push_back(std::move(json));
    return true;
  }

  void note(const std::string& text) { entry_["notes"].push_back(text); }

  Json entry_;
  Trajectory truth_;
};

}  // namespace

std::string comparison_json(const std::string& output, const std::string& baseline, const std::vector<Peer>& peers,
                            const std::string& command) {
  const Json batch = read_summary(output), other = baseline.empty() ? Json::object() : read_summary(baseline);
  Json json;
  json["schema"] = kComparisonSchema;
  add_origin(json, command);
  json["batch"] = output;
  json["baseline"] = baseline.empty() ? Json(nullptr) : Json(baseline);
  json["peers"] = Json::array();
  for (const auto& peer : peers) json["peers"].push_back({{"name", peer.name}, {"folder", peer.folder}});
  json["sequences"] = Json::array();
  try {
    std::map<std::string, Json> of_baseline;
    if (!baseline.empty())
      for (const auto& entry : other.at("sequences")) of_baseline[entry.at("name")] = entry;
    for (const auto& entry : batch.at("sequences")) {
      const std::string name = entry.at("name");
      Comparison comparison(name);
      json["sequences"].push_back(
          ran(entry) ? comparison.compare(member_folder(output, name), name, baseline, of_baseline[name], peers)
                     : comparison.nothing());
    }
  } catch (const Json::exception& problem) {
    throw DataError(output + ": " + problem.what() + "; expected the summaries of batches");
  }
  return json_text(json);
}

}  // namespace quadedge::report
