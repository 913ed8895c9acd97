#pragma once
/// \file source_line.hpp  Converts a custom camera to and from words of a command line, for list files of batches.

#include <string>
#include <vector>

#include "quadedge/stereo_source.hpp"

namespace quadedge::data {

/// Whether a line of a list describes a custom camera, that is, begins with an option.
bool is_source_line(const std::string& text);

/// The source described by a line such as `--left a/left --right a/right --calibration rig.yaml`; words with spaces are
/// in double quotes. Paths are relative to `folder`. `file` and `line` are used in messages. \throws DataError for an
/// option other than those of `quadedge run` for custom cameras
StereoSource parse_source_line(const std::string& text, const std::string& folder, const std::string& file, int line);

/// The words that describe the source on the command line of `quadedge run`.
std::vector<std::string> source_words(const StereoSource& source);

/// A short name for a sequence of image folders or videos: the file name of a video, or NAME for `NAME/left`,
/// `NAME/cam0/data` or `NAME/mav0/cam0/data`.
std::string source_name(const StereoSource& source);

}  // namespace quadedge::data
