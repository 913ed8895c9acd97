/// \file calibration_report.cpp  The numbers as JSON and as a table; displacements as enlarged strokes on a grid.
#include "output/calibration_report.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "common/numeric.hpp"
#include "common/printed.hpp"
#include "output/canvas.hpp"

namespace quadedge::report {
namespace {

Json both_sides(const std::array<double, 2>& values) {
  return {{"left", to_json(values[0])}, {"right", to_json(values[1])}};
}

Json parts_json(const UnseenDistances& parts) {
  Json json = {{"columns", UnseenDistances::kColumns}, {"rows", UnseenDistances::kRows}};
  const auto array = [](const auto& values) {
    Json list = Json::array();
    for (const double value : values) list.push_back(to_json(value));
    return list;
  };
  json["left"] = array(parts.by_place[0]);
  json["right"] = array(parts.by_place[1]);
  json["by_distance"] = array(parts.by_distance);
  return json;
}

template <class... Values>
std::string line(const char* format, Values... values) {
  return printed(format, values...) + "\n";
}

}  // namespace

Json to_json(const DriveCalibration& result) {
  Json json;
  json["verdict"] = to_string(result.verdict);
  json["text"] = result.text();
  json["frames"] = result.frames;
  json["pairs"] = result.pairs;
  json["points"] = result.points;
  json["contradiction"] = to_json(result.contradiction);
  json["unseen_px"] = {{"given", both_sides(result.unseen_given)}, {"learned", both_sides(result.unseen_learned)}};
  json["unseen_parts_px"] = {{"farthest_m", UnseenDistances::kFarthest},
                             {"given", parts_json(result.unseen_parts_given)},
                             {"learned", parts_json(result.unseen_parts_learned)}};
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
    json["depth_error"].push_back({{"depth_m", at.depth}, {"percent", to_json(100 * at.error)}});
  json["rotation_deg"] = result.change.rotation / kDegree;
  json["largest_displacement_px"] = both_sides(result.change.largest_displacement);
  json["sampson_px"] = {{"given", to_json(result.change.sampson_given)},
                        {"learned", to_json(result.change.sampson_learned)}};
  json["covariance"] = Json::array();
  for (Eigen::Index row = 0; row < result.covariance.rows(); ++row) {
    Json values = Json::array();
    for (Eigen::Index column = 0; column < result.covariance.cols(); ++column)
      values.push_back(result.covariance(row, column));
    json["covariance"].push_back(std::move(values));
  }
  return json;
}

std::string calibration_json(const DriveCalibration& result, const std::string& command) {
  Json json;
  add_origin(json, command);
  json.update(to_json(result));
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
  table += line("  epipolar (Sampson)    %.3f px, learned %.3f px", result.change.sampson_given,
                result.change.sampson_learned);
  table += "\npoints in frames that were not learned from, by distance (given, learned):\n";
  for (std::size_t i = 0; i < UnseenDistances::kFarthest.size(); ++i) {
    const double given = result.unseen_parts_given.by_distance[i], learned = result.unseen_parts_learned.by_distance[i];
    if (!std::isfinite(given) || !std::isfinite(learned)) continue;
    const bool is_last = i + 1 == UnseenDistances::kFarthest.size();
    table += line("  %-6s %4.0f m         %.3f px, %.3f px", is_last ? "beyond" : "up to",
                  UnseenDistances::kFarthest[is_last ? i - 1 : i], given, learned);
  }
  return table;
}

namespace {

constexpr int kPanel = 720, kGap = 12;  // px of the pictures

/// A row of panels: the cells of both images, grey by their median distance, white at `most` px.
void draw_places(cv::Mat& picture, int top, int height, const UnseenDistances& parts, double most) {
  for (const Side side : kSides) {
    const int left = index_of(side) * (kPanel + kGap);
    for (int i = 0; i < UnseenDistances::kRows * UnseenDistances::kColumns; ++i) {
      const int column = i % UnseenDistances::kColumns, row = i / UnseenDistances::kColumns;
      const int x = column * kPanel / UnseenDistances::kColumns, y = row * height / UnseenDistances::kRows;
      const cv::Rect cell(left + x, top + y, (column + 1) * kPanel / UnseenDistances::kColumns - x,
                          (row + 1) * height / UnseenDistances::kRows - y);
      const double value = parts.by_place[static_cast<std::size_t>(index_of(side))][static_cast<std::size_t>(i)];
      if (std::isfinite(value))
        cv::rectangle(picture, cell, cv::Scalar::all(40 + 215 * std::min(1.0, value / most)), cv::FILLED);
      cv::rectangle(picture, cell, {60, 60, 60});
      if (std::isfinite(value))
        put_text(picture, printed("%.2f", value), cell.x + 4, cell.y + cell.height - 5,
                 value > most / 2 ? cv::Scalar(0, 0, 0) : cv::Scalar(230, 230, 230), 0.4);
    }
  }
}

}  // namespace

void draw_displacements(const std::string& path, const DriveCalibration& result) {
  constexpr int kStep = 36, kDepth = 4;  // px of the picture; fractional bits
  const PinholeCamera cameras[] = {result.given.left.camera, result.given.right.camera};
  const double largest = std::max({result.change.largest_displacement[0], result.change.largest_displacement[1], 0.01});
  const double enlarged = std::max(1.0, std::floor(1.5 * kStep / largest));  // in units of the picture
  int height = 0;
  for (const PinholeCamera& camera : cameras) height = std::max(height, camera.height * kPanel / camera.width);
  const int part = height + kLegendLine + 8;
  cv::Mat picture = cv::Mat::zeros(3 * part, 2 * kPanel + kGap, CV_8UC3);
  for (const Side side : kSides) {
    const PinholeCamera& camera = cameras[index_of(side)];
    const double scale = static_cast<double>(kPanel) / camera.width;
    const int left = index_of(side) * (kPanel + kGap);
    cv::rectangle(picture, cv::Rect(left, 0, kPanel, static_cast<int>(camera.height * scale)), {60, 60, 60});
    for (int y = kStep / 2; y < camera.height * scale; y += kStep) {
      for (int x = kStep / 2; x < kPanel; x += kStep) {
        const Eigen::Vector2d moved =
            displacement(result.given, result.learned, side, Eigen::Vector2d(x / scale, y / scale));
        if (!moved.allFinite()) continue;
        const auto end = [&](double factor) {
          return cv::Point(static_cast<int>(std::lround((left + x + factor * moved.x()) * (1 << kDepth))),
                           static_cast<int>(std::lround((y + factor * moved.y()) * (1 << kDepth))));
        };
        cv::line(picture, end(0), end(enlarged), wheel_colour(std::atan2(moved.y(), moved.x()) / (2 * kPi)), 1,
                 cv::LINE_AA, kDepth);
        cv::circle(picture, end(0), 2 << kDepth, {200, 200, 200}, cv::FILLED, cv::LINE_AA, kDepth);
      }
    }
  }
  const std::string legend = printed(
      "displacement of pixels from where the given calibration predicts them, %.0f px drawn per px; largest "
      "%.2f px (left), %.2f px (right)",
      enlarged, result.change.largest_displacement[0], result.change.largest_displacement[1]);
  put_text(picture, legend, 6, height + kLegendLine - 4, {230, 230, 230});
  double most = 0.01;
  for (const auto& places : result.unseen_parts_given.by_place)
    for (const double value : places)
      if (value > most) most = value;
  const auto unseen = [&](int row, const UnseenDistances& parts, const char* which) {
    draw_places(picture, row * part, height, parts, most);
    put_text(
        picture,
        std::string("points in frames that were not learned from, median distance from their predictions with the ") +
            which + " calibration [px]",
        6, row * part + height + kLegendLine - 4, {230, 230, 230});
  };
  unseen(1, result.unseen_parts_given, "given");
  unseen(2, result.unseen_parts_learned, "learned");
  write_png(path, picture);
}

}  // namespace quadedge::report
