/// \file calibration_report.cpp  The numbers as JSON and as a table.
#include "output/calibration_report.hpp"

#include "common/numeric.hpp"
#include "common/printed.hpp"

namespace quadedge::report {
namespace {

Json both_sides(const std::array<double, 2>& values) { return {{"left", values[0]}, {"right", values[1]}}; }

template <class... Values>
std::string line(const char* format, Values... values) {
  return printed(format, values...) + "\n";
}

}  // namespace

std::string calibration_json(const DriveCalibration& result, const std::string& command) {
  Json json;
  add_origin(json, command);
  json["verdict"] = to_string(result.verdict);
  json["text"] = result.text();
  json["frames"] = result.frames;
  json["pairs"] = result.pairs;
  json["points"] = result.points;
  json["contradiction"] = result.contradiction;
  json["unseen_px"] = {{"given", both_sides(result.unseen_given)}, {"learned", both_sides(result.unseen_learned)}};
  json["numbers"] = Json::array();
  for (const LearnedNumber& number : result.numbers) {
    json["numbers"].push_back({{"name", number.name},
                               {"unit", number.unit},
                               {"change", number.change},
                               {"sigma", number.sigma},
                               {"prior", number.prior},
                               {"open", number.is_open()}});
  }
  json["depth_error"] = Json::array();
  for (const auto& at : result.change.depths)
    json["depth_error"].push_back({{"depth_m", at.depth}, {"percent", 100 * at.error}});
  json["rotation_deg"] = result.change.rotation / kDegree;
  json["largest_displacement_px"] = both_sides(result.change.largest_displacement);
  json["covariance"] = Json::array();
  for (Eigen::Index row = 0; row < result.covariance.rows(); ++row) {
    Json values = Json::array();
    for (Eigen::Index column = 0; column < result.covariance.cols(); ++column)
      values.push_back(result.covariance(row, column));
    json["covariance"].push_back(std::move(values));
  }
  return json_text(json);
}

std::string calibration_table(const DriveCalibration& result) {
  if (result.numbers.empty()) return {};
  std::string table = line("%-26s %12s %12s %11s", "number", "change", "deviation", "prior");
  for (const LearnedNumber& number : result.numbers) {
    const std::string deviation = number.is_open() ? "not observed" : printed("%.6f", number.sigma);
    table += line("%-26s %+12.6f %12s %11.6f %s", number.name.c_str(), number.change, deviation.c_str(), number.prior,
                  number.unit.c_str());
  }
  table += "\nwith the given calibration, if the learned one is true:\n";
  for (const auto& at : result.change.depths)
    table += line("  depth at %2.0f m         off by %.2f %%", at.depth, 100 * at.error);
  table += line("  right camera          turned by %.4f degrees", result.change.rotation / kDegree);
  table += line("  pixels                displaced by up to %.2f px (left), %.2f px (right)",
                result.change.largest_displacement[0], result.change.largest_displacement[1]);
  return table;
}

}  // namespace quadedge::report
