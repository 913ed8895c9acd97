#include "data/find_sequences.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <map>
#include <set>
#include <sys/stat.h>
#include <system_error>
#include <utility>

#include "data/layout.hpp"
#include "data/source_line.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

/// Layout of the recording in this very folder; empty if it is not a recording.
std::string recording_format(const fs::path& folder, bool with_pairs) {
  for (const auto& layout : layouts()) {
    const bool pair = layout.is_recording == nullptr;
    if (pair ? with_pairs && layout.recognise(folder) : layout.is_recording(folder)) return layout.name;
  }
  return {};
}

/// Sorted subfolders, without hidden ones but including entries whose kind cannot be determined, such as a link to
/// itself.
std::vector<fs::path> folders_in(const fs::path& folder) {
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(folder)) {
    std::error_code error;
    const bool is_folder = entry.is_directory(error);
    const bool unknown = error && error != std::errc::no_such_file_or_directory;
    if ((is_folder || unknown) && entry.path().filename().string()[0] != '.') folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

/// Device and inode of a folder, the same under all of its paths.
using FolderId = std::pair<dev_t, ino_t>;

/// \throws fs::filesystem_error for a folder that cannot be reached.
FolderId id_of(const fs::path& folder) {
  struct stat facts {};
  if (stat(folder.c_str(), &facts) != 0)
    throw fs::filesystem_error("stat", folder, std::error_code(errno, std::generic_category()));
  return {facts.st_dev, facts.st_ino};
}

/// Adds the recordings in and below a folder, and folders that cannot be read, without a format. `seen` contains the
/// folders so far, so that circular links end.
void search(const fs::path& folder, bool with_pairs, std::set<FolderId>& seen, std::vector<FoundRecording>& found) {
  std::vector<fs::path> folders;
  try {
    if (!seen.insert(id_of(folder)).second) return;
    if (const std::string format = recording_format(folder, with_pairs); !format.empty()) {
      found.push_back({folder.string(), format, {}});
      return;
    }
    folders = folders_in(folder);
  } catch (const fs::filesystem_error&) {
    found.push_back({folder.string(), "", {}});
    return;
  }
  for (const auto& below : folders) search(below, with_pairs, seen, found);
}

std::vector<FoundRecording> search_list(const std::string& list) {
  std::set<FolderId> seen;
  std::vector<FoundRecording> found;
  const std::string folder = fs::path(list).parent_path().string();
  for (const auto& line : data_lines(list)) {
    if (is_source_line(line.text)) {
      const StereoSource source = parse_source_line(line.text, folder, list, line.number);
      found.push_back({source.video.empty() ? source.left : source.video, "", source});
      continue;
    }
    const auto last = line.text.find_last_not_of(" \t");
    const fs::path entry = fs::path(folder) / line.text.substr(0, last + 1);
    std::error_code error;
    const bool known = fs::exists(entry, error) && seen.count(id_of(entry)) > 0;
    const std::size_t before = found.size();
    if (fs::is_directory(entry, error)) search(entry, false, seen, found);
    if (found.size() == before && !known) found.push_back({entry.string(), "", {}});
  }
  return found;
}

/// The last `parts` names of a path, joined; KITTI's two digits are prefixed with the name of the layout.
std::string name_of(const FoundRecording& recording, int parts) {
  fs::path rest = whole_path(recording.path);
  if (recording.source) rest = rest.parent_path() / source_name(*recording.source);
  if (rest.filename() == "mav0") rest = rest.parent_path();
  std::string name = (recording.format == "kitti" ? "kitti_" : "") + rest.filename().string();
  for (int i = 1; i < parts && rest.parent_path().has_filename(); ++i) {
    rest = rest.parent_path();
    name = rest.filename().string() + "_" + name;
  }
  return plain_name(name);
}

/// Short names if they are unique, otherwise longer ones.
std::vector<FoundSequence> named(const std::vector<FoundRecording>& recordings) {
  constexpr int kMostParts = 8;
  std::vector<FoundSequence> sequences;
  for (const auto& recording : recordings)
    sequences.push_back({name_of(recording, 1), recording.path, recording.format, recording.source});
  for (int parts = 2; parts <= kMostParts; ++parts) {
    std::map<std::string, int> uses;
    for (const auto& sequence : sequences) ++uses[sequence.name];
    for (std::size_t i = 0; i < sequences.size(); ++i) {
      if (uses[sequences[i].name] > 1) sequences[i].name = name_of(recordings[i], parts);
    }
  }
  std::set<std::string> taken;
  for (auto& sequence : sequences) {
    const std::string name = sequence.name;
    for (int i = 2; !taken.insert(sequence.name).second; ++i) sequence.name = name + "_" + std::to_string(i);
  }
  return sequences;
}

}  // namespace

std::vector<FoundRecording> find_recordings(const std::string& root, bool with_pairs) {
  std::set<FolderId> seen;
  std::vector<FoundRecording> found;
  search(root, with_pairs, seen, found);
  return found;
}

std::string plain_name(const std::string& text) {
  constexpr std::size_t kLongest = 128;  // file systems permit 255 bytes, and names are joined
  std::string name;
  for (const char c : text.substr(0, kLongest)) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.';
    name += plain ? c : '_';
  }
  return name.empty() || name == "." || name == ".." ? "sequence" : name;
}

std::vector<FoundSequence> find_sequences(const std::string& root_or_list) {
  std::error_code error;
  if (!fs::exists(root_or_list, error)) {
    fail(root_or_list, error ? "a place that cannot be read (" + error.message() + ")" : "no such file or folder",
         "a folder of sequences, or a list of folders");
  }
  if (!fs::is_directory(root_or_list)) {
    const auto recordings = search_list(root_or_list);
    if (recordings.empty()) fail(root_or_list, "no line", "the folder of a sequence on every line");
    return named(recordings);
  }
  const auto recordings = find_recordings(root_or_list, false);
  if (recordings.empty()) {
    if (const std::size_t pairs = find_recordings(root_or_list, true).size(); pairs > 0) {
      fail(root_or_list, counted(pairs, "still pair") + ", which have no motion",
           "recordings of many frames; `quadedge match` and `quadedge evaluate matching` are for pairs");
    }
    std::string names;
    for (const auto& layout : layouts()) {
      if (layout.is_recording != nullptr) names += (names.empty() ? "" : ", ") + layout.name;
    }
    fail(root_or_list, "no sequence in it or below", "recordings in the layouts " + names);
  }
  return named(recordings);
}

}  // namespace quadedge::data
