#include "cli/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "quadedge/error.hpp"
#include "quadedge/filters.hpp"

namespace quadedge::cli {
namespace {

/// Which filter a constant belongs to; the beginning of its name decides.
template <class Filter>
struct Belongs {
  const char* key;
  Filter filter;
};
constexpr Belongs<StereoFilter> kStereo[] = {{"stereo.epipolar_distance", StereoFilter::epipolar_distance},
                                             {"stereo.min_depth", StereoFilter::disparity},
                                             {"stereo.max_disparity", StereoFilter::disparity},
                                             {"stereo.orientation", StereoFilter::orientation},
                                             {"stereo.sift_max", StereoFilter::sift},
                                             {"stereo.ncc_min", StereoFilter::ncc},
                                             {"stereo.ncc_nearly_best", StereoFilter::nearly_best_ncc},
                                             {"stereo.sift_nearly_best", StereoFilter::nearly_best_sift},
                                             {"stereo.shift", StereoFilter::refinement},
                                             {"stereo.refine_", StereoFilter::refinement},
                                             {"stereo.cluster", StereoFilter::refinement},
                                             {"stereo.refined_ncc_min", StereoFilter::similarity},
                                             {"stereo.refined_ncc_min", StereoFilter::relaxation},
                                             {"stereo.relaxation", StereoFilter::relaxation},
                                             {"stereo.support_weight", StereoFilter::relaxation}};
constexpr Belongs<TemporalFilter> kTemporal[] = {{"temporal.radius", TemporalFilter::displacement},
                                                 {"temporal.orientation", TemporalFilter::orientation},
                                                 {"temporal.ncc_min", TemporalFilter::ncc},
                                                 {"temporal.sift_max", TemporalFilter::sift},
                                                 {"temporal.ncc_nearly_best", TemporalFilter::nearly_best_ncc},
                                                 {"temporal.sift_nearly_best", TemporalFilter::nearly_best_sift}};

/// Rows of the filters that a constant belongs to, then the last row.
template <class Filter, std::size_t Size>
std::vector<int> rows_of(const std::string& key, const Belongs<Filter> (&table)[Size]) {
  std::vector<int> rows;
  for (const auto& entry : table) {
    if (key.rfind(entry.key, 0) == 0) rows.push_back(order_of(entry.filter));
  }
  rows.push_back(order_of(Filter::best));
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
  sweep.stereo_orders = rows_of(sweep.key, kStereo);
  sweep.temporal_orders = rows_of(sweep.key, kTemporal);
  with_value({}, sweep.key, first);
  return sweep;
}

Config with_value(Config config, const std::string& key, double value) {
  const auto& all = constants();
  const auto constant =
      std::find_if(all.begin(), all.end(), [&](const Constant& candidate) { return candidate.key() == key; });
  const ConfigField field = constant == all.end() ? ConfigField(static_cast<bool*>(nullptr)) : constant->field(config);
  if (auto* const* real = std::get_if<double*>(&field)) {
    **real = value;
  } else if (auto* const* whole = std::get_if<int*>(&field)) {
    **whole = static_cast<int>(std::lround(value));
  } else {
    throw UsageError("--sweep: no numeric constant '" + key + "'; --help-all lists all constants");
  }
  check_config(config);
  return config;
}

}  // namespace quadedge::cli
