#pragma once
/// \file errors_csv.hpp  errors.csv: the errors of every pose that has ground truth.

#include <string>

#include "quadedge/evaluation.hpp"
#include "report/csv_table.hpp"

namespace quadedge::report {

/// Columns: stamp_s, ape_rotation_deg, ape_translation_m, rpe_rotation_deg, rpe_translation_m; origin-aligned. The
/// first pose of a segment has no step before it: its RPE fields are empty.
std::string errors_csv(const TrajectoryEvaluation& evaluation);

/// \throws DataError for a missing or damaged file.
CsvTable read_errors_csv(const std::string& file);

}  // namespace quadedge::report
