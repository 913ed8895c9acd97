#pragma once
/// \file localisation_files.hpp  locations.csv and localisation.json: what `quadedge localise` writes beside the
/// trajectory.

#include <optional>
#include <string>
#include <vector>

#include "quadedge/localiser.hpp"
#include "report/csv_table.hpp"
#include "report/run_record.hpp"

namespace quadedge::report {

/// A frame and its number in the recording, from 0.
struct NumberedLocalisation {
  int number;
  const Localisation& result;
};

/// Columns: frame, stamp_s, status, key_rig, followed, inliers, support; x, y, z [m] and qx, qy, qz, qw of the left
/// camera in the map; latency_ms, warning, message. Fields without a value are empty.
const std::vector<CsvColumn<NumberedLocalisation>>& locations_csv_columns();

/// One localisation of a recording.
struct LocalisationRecord {
  std::string command;      ///< its command line
  std::string ended_early;  ///< as in RunRecord
  std::string map_file;
  std::size_t key_rigs = 0;  ///< of the map
  InputFacts input;
  DeviceInfo device;
  Config config;  ///< effective
  std::vector<Localisation> frames;
  std::string truth_file;                        ///< empty without ground truth
  std::optional<TrajectoryEvaluation> accuracy;  ///< only with ground truth

  int located() const {
    int count = 0;
    for (const auto& frame : frames) count += frame.status == LocalisationStatus::located ? 1 : 0;
    return count;
  }
};

/// Why frames were lost: "5 unknown place, 2 ambiguous"; empty if there are none.
std::string lost_reasons(const std::vector<Localisation>& frames);

/// Median time per frame, except the first, which warms up [ms].
double median_latency_ms(const std::vector<Localisation>& frames);

/// localisation.json.
std::string localisation_json(const LocalisationRecord& record);

}  // namespace quadedge::report
