/// \file find_sequences.cpp  Searches folders, each inode once; names have as many path components as tell them apart.
#include "data/find_sequences.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <filesystem>
#include <iomanip>
#include <map>
#include <set>
#include <sstream>
#include <sys/stat.h>
#include <system_error>
#include <utility>
#include <variant>

#include "data/layout.hpp"
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

/// Device and inode of a folder, the same under all of its paths. Unlike a canonical path they take no longer in a
/// deeper folder.
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
    if (line.text.rfind("--", 0) == 0) {  // an option: a custom camera
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
  for (const auto& recording : recordings) sequences.push_back({recording, name_of(recording, 1)});
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
    fail(root_or_list, error ? "a path that cannot be read (" + error.message() + ")" : "no such file or folder",
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
           "recordings of many frames; `quadedge match` and `python -m quadedge.matching` are for pairs");
    }
    std::string names;
    for (const auto& layout : layouts()) {
      if (layout.is_recording != nullptr) names += std::string(names.empty() ? "" : ", ") + layout.name;
    }
    fail(root_or_list, "no sequence in it or below", "recordings in the layouts " + names);
  }
  return named(recordings);
}

namespace {

/// An option that a line may have.
struct SourceOption {
  const char* name;
  std::variant<std::string StereoSource::*, double StereoSource::*, bool StereoSource::*> value;
  bool is_path = false;
};
constexpr SourceOption kOptions[] = {{"--left", &StereoSource::left, true},
                                     {"--right", &StereoSource::right, true},
                                     {"--video", &StereoSource::video, true},
                                     {"--split", &StereoSource::split},
                                     {"--calibration", &StereoSource::calibration, true},
                                     {"--times", &StereoSource::times, true},
                                     {"--mask", &StereoSource::mask, true},
                                     {"--fps", &StereoSource::fps},
                                     {"--fov", &StereoSource::fov},
                                     {"--tolerance", &StereoSource::tolerance_ms},
                                     {"--rectified", &StereoSource::rectified},
                                     {"--restarts", &StereoSource::restarts}};

/// Prepends `folder` to each of the comma-separated paths.
std::string in_folder(const std::string& paths, const fs::path& folder) {
  std::string result;
  for (const auto& path : split(paths, ",")) result += (result.empty() ? "" : ",") + (folder / path).string();
  return result;
}

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; stream >> std::quoted(word);) words.push_back(word);
  return words;
}

}  // namespace

StereoSource parse_source_line(const std::string& text, const std::string& folder, const std::string& file, int line) {
  StereoSource source;
  const auto words = words_of(text);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto* option = std::find_if(std::begin(kOptions), std::end(kOptions),
                                      [&](const SourceOption& each) { return words[i] == each.name; });
    const bool is_known = option != std::end(kOptions), has_value = i + 1 < words.size();
    if (const auto* flag = is_known ? std::get_if<bool StereoSource::*>(&option->value) : nullptr) {
      source.** flag = true;
      continue;
    }
    if (!is_known || !has_value) {
      std::string options;
      for (const SourceOption& each : kOptions) options += std::string(each.name) + " ";
      fail(file, line, in_quotes(words[i]) + (has_value ? "" : " without a value"),
           "one of " + options + "with its value");
    }
    const std::string& value = words[++i];
    if (const auto* word = std::get_if<std::string StereoSource::*>(&option->value))
      source.** word = option->is_path ? in_folder(value, folder) : value;
    else
      source.*std::get<double StereoSource::*>(option->value) = parse_number(value, file, line, option->name);
  }
  return source;
}

std::vector<std::string> source_words(const StereoSource& source) {
  std::vector<std::string> words;
  for (const SourceOption& option : kOptions) {
    const auto add = [&](const auto& value) {
      using Value = std::decay_t<decltype(value)>;
      if (value == Value()) return;
      words.emplace_back(option.name);
      if constexpr (std::is_same_v<Value, std::string>) words.push_back(value);
      if constexpr (std::is_same_v<Value, double>) words.push_back(format_exact(value));
    };
    std::visit([&](const auto member) { add(source.*member); }, option.value);
  }
  return words;
}

std::string source_name(const StereoSource& source) {
  const std::string first = source.video.empty() ? source.left : source.video;
  std::error_code ignored;
  if (!fs::is_directory(first, ignored)) return fs::path(first).stem().string();
  fs::path folder = whole_path(first);
  if (folder.filename() == "data") folder = folder.parent_path();
  folder = folder.parent_path();
  if (folder.filename() == "mav0") folder = folder.parent_path();
  return folder.has_filename() ? folder.filename().string() : folder_name(first);
}

std::string one_line(const DatasetCheck& check) {
  std::string line;
  const auto add = [&](const std::string& text) { line += (line.empty() ? "" : ", ") + text; };
  // Value of a fact: for cameras the image size only, for files without the path.
  const auto value_of = [&](const std::string& name) {
    for (const auto& fact : check.facts) {
      if (fact.rfind(name + ": ", 0) == 0) return fact.substr(name.size() + 2);
    }
    return std::string();
  };
  add(value_of("format"));
  if (const auto frames = value_of("frames"); !frames.empty()) add(frames + (frames == "1" ? " frame" : " frames"));
  if (const auto camera = value_of("left camera"); !camera.empty()) add(camera.substr(0, camera.find(',')) + " px");
  if (const auto truth = value_of("ground truth"); truth.rfind(", ") != std::string::npos) {
    add("ground truth of " + truth.substr(truth.rfind(", ") + 2));
  }
  if (!value_of("disparity of the left view").empty()) add("ground-truth disparity");
  if (!check.warnings.empty()) add(counted(check.warnings.size(), "warning"));
  return line;
}

}  // namespace quadedge::data
