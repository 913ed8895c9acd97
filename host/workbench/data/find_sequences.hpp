#pragma once
/// \file find_sequences.hpp  Finds the sequences below a folder or in a list file.

#include <optional>
#include <string>
#include <vector>

#include "quadedge/dataset.hpp"
#include "quadedge/stereo_source.hpp"

namespace quadedge::data {

/// A folder with recorded data, or an unreadable folder without a format.
struct FoundRecording {
  std::string path;                                   ///< folder; of a custom camera its first folder or file
  std::string format;                                 ///< recognised layout; empty without a recording
  std::optional<StereoSource> source = std::nullopt;  ///< custom camera
};

/// A sequence of a batch.
struct FoundSequence : FoundRecording {
  std::string name;  ///< unique in its batch; contains only letters, digits and -_., so that it can name a folder
};

/// For a folder: every recording of any layout below it, following links, sorted by path, without still pairs. Damaged
/// recordings are included as long as their folders have the usual names. For a file: one folder per line, relative to
/// the folder of the file; '#' starts a comment. Each folder is searched in the same way; a line without a recording
/// remains in the result, and a line of options describes a custom camera. There are no duplicates.
/// \throws DataError for a missing or empty root or list
std::vector<FoundSequence> find_sequences(const std::string& root_or_list);

/// The recordings in and below a folder, sorted by path, following links; optionally with still pairs. Includes
/// unreadable folders, links to themselves and paths that are too long.
std::vector<FoundRecording> find_recordings(const std::string& root, bool with_pairs);

/// The text with everything except letters, digits and -_. replaced by '_', shortened to a permitted folder name.
std::string plain_name(const std::string& text);

// Converts a custom camera to and from words of a command line, for list files of batches.

/// The source described by a line such as `--left a/left --right a/right --calibration rig.yaml`; words with spaces are
/// in double quotes. Paths are relative to `folder`. `file` and `line` are used in messages. \throws DataError for an
/// option other than those of `quadedge run` for custom cameras
StereoSource parse_source_line(const std::string& text, const std::string& folder, const std::string& file, int line);

/// The words that describe the source on the command line of `quadedge run`.
std::vector<std::string> source_words(const StereoSource& source);

/// A short name for a sequence of image folders or videos: the file name of a video, or NAME for `NAME/left`,
/// `NAME/cam0/data` or `NAME/mav0/cam0/data`.
std::string source_name(const StereoSource& source);

/// One line about a checked member: layout, number of frames, size, ground truth, number of warnings.
std::string one_line(const DatasetCheck& check);

}  // namespace quadedge::data
