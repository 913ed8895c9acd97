#pragma once
/// \file json_values.hpp  Parts that several JSON results share. Included only by the few files that write
/// or read JSON.

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "output/run_record.hpp"
#include "quadedge/config.hpp"
#include "quadedge/device.hpp"
#include "quadedge/evaluation.hpp"

namespace quadedge::report {

using Json = nlohmann::ordered_json;

/// JSON has no NaN: a value that does not exist is null.
inline Json to_json(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

inline Json to_json(const ErrorStatistics& error) {
  return {{"mean", to_json(error.mean)},
          {"std", to_json(error.std)},
          {"rmse", to_json(error.rmse)},
          {"max", to_json(error.max)}};
}

inline Json to_json(const PoseErrors& errors) {
  return {{"ape_rotation_deg", to_json(errors.ape_rotation_deg)},
          {"ape_translation_m", to_json(errors.ape_translation_m)},
          {"rpe_rotation_deg", to_json(errors.rpe_rotation_deg)},
          {"rpe_translation_m", to_json(errors.rpe_translation_m)}};
}

inline Json to_json(const LatencySummary& latency) {
  return {{"median", to_json(latency.median)},
          {"p90", to_json(latency.p90)},
          {"p99", to_json(latency.p99)},
          {"max", to_json(latency.max)},
          {"first", to_json(latency.first)}};
}

inline Json to_json(const FloatSupport& support) {
  Json rounding = Json::array();
  if (support.rounds_to_nearest) rounding.push_back("nearest");
  if (support.rounds_to_zero) rounding.push_back("zero");
  if (support.rounds_to_infinity) rounding.push_back("infinity");
  return {{"fma", support.fma},
          {"denormals", support.denormals},
          {"rounding", rounding},
          {"correctly_rounded_divide_sqrt", support.exact_divide_sqrt}};
}

inline Json to_json(const DeviceInfo& device) {
  return {{"name", device.name},     {"platform", device.platform},
          {"driver", device.driver}, {"opencl", device.opencl},
          {"type", device.type},     {"single_precision", to_json(device.single_precision)}};
}

/// Commit that this program was built from, with a "+" where the sources had changed; empty when built outside a
/// checkout.
const char* source_commit();

/// The figures of an evaluation; without the numbers of poses, the errors of each pose, and the segments.
Json to_json(const TrajectoryEvaluation& evaluation);

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
