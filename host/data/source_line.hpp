#pragma once
/// \file source_line.hpp  A camera of one's own as words of a command line, and back: lines of a batch's list.

#include <string>
#include <vector>

#include "quadedge/stereo_source.hpp"

namespace quadedge::data {

/// Whether a line of a list names a camera of one's own: it begins with an option.
bool is_source_line(const std::string& text);

/// The source that a line such as `--left a/left --right a/right --calibration rig.yaml` names; words with spaces stand
/// in double quotes. Paths are relative to `folder`. `file` and `line`: for messages. \throws DataError for an option
/// that is none of `quadedge run`'s for cameras of one's own.
StereoSource parse_source_line(const std::string& text, const std::string& folder, const std::string& file, int line);

/// The words that name the source on the command line of `quadedge run`.
std::vector<std::string> source_words(const StereoSource& source);

/// A short name of a sequence of image folders or videos: of a video the file's, of `NAME/left`, `NAME/cam0/data` or
/// `NAME/mav0/cam0/data` NAME.
std::string source_name(const StereoSource& source);

}  // namespace quadedge::data
