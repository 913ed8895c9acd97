#pragma once
/// \file find_sequences.hpp  Finds the sequences below a folder or in a list file.

#include <optional>
#include <string>
#include <vector>

#include "quadedge/stereo_source.hpp"

namespace quadedge::data {

/// A sequence of a batch.
struct FoundSequence {
  std::string name;  ///< unique in its batch; contains only letters, digits and -_., so that it can name a folder
  std::string path;  ///< folder of the sequence
  std::string
      format;  ///< recognised layout; empty for a line of a list without a recording, and for an unreadable folder
  std::optional<StereoSource> source;  ///< custom camera; `path` is then its first folder or file
};

/// For a folder: every recording of any layout below it, following links, sorted by path, without still pairs. Damaged
/// recordings are included as long as their folders have the usual names. For a file: one folder per line, relative to
/// the folder of the file; '#' starts a comment. Each folder is searched in the same way; a line without a recording
/// remains in the result, and a line of options describes a custom camera (source_line.hpp). There are no duplicates.
/// \throws DataError for a missing or empty root or list
std::vector<FoundSequence> find_sequences(const std::string& root_or_list);

/// A folder with recorded data, or an unreadable folder without a format.
struct FoundRecording {
  std::string path, format;
  std::optional<StereoSource> source = std::nullopt;  ///< see FoundSequence
};

/// The recordings in and below a folder, sorted by path, following links; optionally with still pairs. Includes
/// unreadable folders, links to themselves and paths that are too long.
std::vector<FoundRecording> find_recordings(const std::string& root, bool with_pairs);

/// The text with everything except letters, digits and -_. replaced by '_', shortened to a permitted folder name.
std::string plain_name(const std::string& text);

}  // namespace quadedge::data
