#pragma once
/// \file json_values.hpp  Parts that several JSON results share. Included only by the few files that write
/// or read JSON.

#include <nlohmann/json.hpp>
#include <string>

#include "output/run_record.hpp"
#include "quadedge/config.hpp"
#include "quadedge/device.hpp"
#include "quadedge/evaluation.hpp"

namespace quadedge::report {

using Json = nlohmann::ordered_json;

/// Commit that this program was built from, with a "+" where the sources had changed; empty when built outside a
/// checkout.
const char* source_commit();

inline void to_json(Json& json, const LatencySummary& latency) {
  json = {{"median", latency.median},
          {"p90", latency.p90},
          {"p99", latency.p99},
          {"max", latency.max},
          {"first", latency.first}};
}

/// Adds the origin of a result: `version`, `commit` (null outside a checkout), `date` (UTC) and
/// `command`.
void add_origin(Json& json, const std::string& command);

/// Adds `config`, every constant in its section, and `config_changed`, those that are not at their defaults.
void add_configuration(Json& json, const Config& config);

/// The content of a file. \throws DataError, naming it and what was expected, for a missing or damaged one.
Json read_json(const std::string& file, const char* expected);

/// The text of a file. File names may contain bytes that are not UTF-8; these are replaced.
inline std::string json_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace quadedge::report

namespace quadedge {

// What nlohmann-json turns into JSON by itself; NaN, which JSON does not have, becomes null.

inline void to_json(report::Json& json, const ErrorStatistics& error) {
  json = {{"mean", error.mean}, {"std", error.std}, {"rmse", error.rmse}, {"max", error.max}};
}

inline void to_json(report::Json& json, const PoseErrors& errors) {
  json = {{"ape_rotation_deg", errors.ape_rotation_deg},
          {"ape_translation_m", errors.ape_translation_m},
          {"rpe_rotation_deg", errors.rpe_rotation_deg},
          {"rpe_translation_m", errors.rpe_translation_m}};
}

void to_json(report::Json& json, const DeviceInfo& device);

/// The figures of an evaluation; without the numbers of poses, the errors of each pose, and the segments.
void to_json(report::Json& json, const TrajectoryEvaluation& evaluation);

}  // namespace quadedge
