#pragma once
/// \file frames_csv.hpp  frames.csv: status, counts and times of every input frame.

#include "report/frame_rows.hpp"

namespace quadedge::report {

/// The columns of frames.csv (doc/usage.md). Fields without a value are empty.
const FrameColumns& frames_csv_columns();

/// \throws DataError for a missing or damaged file.
CsvTable read_frames_csv(const std::string& file);

}  // namespace quadedge::report
