#pragma once
/// \file find_sequences.hpp  Which sequences lie below a folder, or are named by a list file.

#include <optional>
#include <string>
#include <vector>

#include "quadedge/stereo_source.hpp"

namespace quadedge::data {

/// A sequence that a batch works on.
struct FoundSequence {
  std::string name;    ///< unique in its batch, letters, digits and -_. alone: a folder can be called so
  std::string path;    ///< the sequence's own folder
  std::string format;  ///< layout by its looks; empty for a line of a list that is no recording, and for a folder that
                       ///< cannot be read (whose run will say why)
  std::optional<StereoSource> source;  ///< of a camera of one's own; then `path` is its first folder or file
};

/// A folder: every recording of any layout below it, links followed, sorted by path. Still pairs are no sequences.
/// Damaged recordings are found, too, as long as their folders have the usual names. A file: one folder per line,
/// relative to the file's folder, '#' starts a comment; each is searched in the same way, and a line that holds no
/// recording stays in the result; a line of options names a camera of one's own (source_line.hpp). Nothing is found
/// twice. \throws DataError for a missing or empty root or list.
std::vector<FoundSequence> find_sequences(const std::string& root_or_list);

/// A folder that holds recorded data; without a format one that cannot be read.
struct FoundRecording {
  std::string path, format;
  std::optional<StereoSource> source = std::nullopt;  ///< as FoundSequence
};

/// The recordings in and below a folder, sorted by path, links followed; with the still pairs on request. Folders that
/// cannot be read, links to themselves and paths that are too long are among them.
std::vector<FoundRecording> find_recordings(const std::string& root, bool with_pairs);

/// The text with everything but letters, digits and -_. replaced by '_', and cut where it is too long for a folder.
std::string plain_name(const std::string& text);

}  // namespace quadedge::data
