#include "cli/sweep.hpp"

#include <cmath>
#include <cstdio>

#include "common/filter_names.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {
namespace {

/// Which filter a constant belongs to; the beginning of its name decides.
struct Belongs {
  const char* key;
  int order;
};
constexpr Belongs kStereo[] = {
    {"stereo.epipolar_distance", 1}, {"stereo.min_depth", 2},        {"stereo.max_disparity", 2},
    {"stereo.orientation", 3},       {"stereo.sift_max", 4},         {"stereo.ncc_min", 5},
    {"stereo.ncc_nearly_best", 6},   {"stereo.sift_nearly_best", 7}, {"stereo.shift", 8},
    {"stereo.refine_", 8},           {"stereo.cluster", 8},          {"stereo.refined_ncc_min", 9}};
constexpr Belongs kTemporal[] = {{"temporal.radius", 1},          {"temporal.orientation", 2},
                                 {"temporal.ncc_min", 3},         {"temporal.sift_max", 4},
                                 {"temporal.ncc_nearly_best", 5}, {"temporal.sift_nearly_best", 6}};

template <class Table>
std::vector<int> rows_of(const std::string& key, const Table& table, int last) {
  std::vector<int> rows;
  for (const auto& entry : table) {
    if (key.rfind(entry.key, 0) == 0 && entry.order != last) rows.push_back(entry.order);
  }
  rows.push_back(last);
  return rows;
}

}  // namespace

Sweep parse_sweep(const std::string& text) {
  const auto equals = text.find('=');
  double first = 0, last = 0, step = 0;
  int length = 0;
  if (equals == std::string::npos ||
      std::sscanf(text.c_str() + equals, "=%lf:%lf:%lf%n", &first, &last, &step, &length) != 3 ||
      equals + static_cast<std::size_t>(length) != text.size() || !(step > 0) || !(last >= first) ||
      !((last - first) / step < 1000)) {
    throw UsageError("--sweep " + text +
                     ": expected SECTION.FIELD=FIRST:LAST:STEP, for example stereo.ncc_min=0.4:0.9:0.05");
  }
  Sweep sweep;
  sweep.key = text.substr(0, equals);
  const int count = static_cast<int>((last - first) / step + 1e-9) + 1;
  for (int i = 0; i < count; ++i) sweep.values.push_back(first + i * step);
  sweep.stereo_orders = rows_of(sweep.key, kStereo, static_cast<int>(kStereoFilters.size()) - 1);
  sweep.temporal_orders = rows_of(sweep.key, kTemporal, static_cast<int>(kTemporalFilters.size()) - 1);
  with_value({}, sweep.key, first);
  return sweep;
}

Config with_value(Config config, const std::string& key, double value) {
  bool found = false;
  visit_config(config, [&](const std::string& name, ConfigField field, const std::string&, double, double) {
    if (name != key) return;
    if (auto** real = std::get_if<double*>(&field)) {
      **real = value;
      found = true;
    } else if (auto** whole = std::get_if<int*>(&field)) {
      **whole = static_cast<int>(std::lround(value));
      found = true;
    }
  });
  if (!found)
    throw UsageError("--sweep: no constant with a numeric value is called '" + key + "'; --help-all lists all of them");
  check_config(config);
  return config;
}

}  // namespace quadedge::cli
