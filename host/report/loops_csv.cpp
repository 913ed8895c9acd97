#include "report/loops_csv.hpp"

#include "data/text.hpp"
#include "report/csv_table.hpp"
#include "report/poses_csv.hpp"

namespace quadedge::report {
namespace {

std::string text(const std::optional<double>& value) { return value ? data::format_exact(*value) : std::string(); }

std::vector<CsvColumn<Closure>> columns_of_loops() {
  std::vector<CsvColumn<Closure>> columns = {
      {"frame", [](const Closure& closure) { return std::to_string(closure.frame); }},
      {"other", [](const Closure& closure) { return std::to_string(closure.other); }},
      {"verdict", [](const Closure& closure) { return to_string(closure.verdict); }},
      {"similarity", [](const Closure& closure) { return data::format_exact(closure.similarity); }},
      {"inliers", [](const Closure& closure) { return std::to_string(closure.inliers); }},
      {"support", [](const Closure& closure) { return data::format_exact(closure.support); }}};
  for (std::size_t i = 0; i < kPoseColumns.size(); ++i) {
    columns.push_back({kPoseColumns[i], [i](const Closure& closure) {
                         return closure.frame_from_other
                                    ? data::format_exact(pose_value(closure.frame_from_other->inverse(), i))
                                    : std::string();
                       }});
  }
  columns.push_back({"deviation", [](const Closure& closure) { return text(closure.deviation); }});
  columns.push_back({"distance_m", [](const Closure& closure) { return text(closure.distance_m); }});
  columns.push_back({"angle_deg", [](const Closure& closure) { return text(closure.angle_deg); }});
  return columns;
}

}  // namespace

std::string loops_csv(const std::vector<Closure>& closures) {
  const auto columns = columns_of_loops();
  std::string rows = csv_heading(columns);
  for (const Closure& closure : closures) rows += csv_row(columns, closure);
  return rows;
}

}  // namespace quadedge::report
