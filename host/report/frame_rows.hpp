#pragma once
/// \file frame_rows.hpp  A CSV file with one row per input frame, written as frames finish: frames.csv, poses.csv.

#include <string>
#include <vector>

#include "quadedge/odometry.hpp"
#include "report/append_file.hpp"
#include "report/csv_table.hpp"

namespace quadedge::report {

/// A frame and its number in the run, from 0.
struct NumberedFrame {
  int number;
  const FrameResult& result;
};

using FrameColumns = std::vector<CsvColumn<NumberedFrame>>;

/// Writes one of the files. All columns are known from the start, so a row is written once and never touched again.
class FrameRows {
 public:
  /// `columns` outlives the object. \throws DataError when the file cannot be written.
  FrameRows(const std::string& path, const FrameColumns& columns) : columns_(columns), file_(path) {
    file_.append(csv_heading(columns_));
  }
  /// Appends the row of the next frame. \throws DataError when it cannot be written.
  void add(const FrameResult& result) { file_.append(csv_row(columns_, {frames_++, result})); }

 private:
  const FrameColumns& columns_;
  AppendFile file_;
  int frames_ = 0;
};

}  // namespace quadedge::report
