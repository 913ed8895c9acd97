#include "data/source_line.hpp"

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <sstream>

#include "data/layout.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

/// An option with a text value.
struct Word {
  const char* option;
  std::string StereoSource::*value;
  bool is_path;
};
constexpr Word kWords[] = {{"--left", &StereoSource::left, true},
                           {"--right", &StereoSource::right, true},
                           {"--video", &StereoSource::video, true},
                           {"--split", &StereoSource::split, false},
                           {"--calibration", &StereoSource::calibration, true},
                           {"--times", &StereoSource::times, true},
                           {"--mask", &StereoSource::mask, true}};

/// An option with a numeric value.
struct Number {
  const char* option;
  double StereoSource::*value;
};
constexpr Number kNumbers[] = {
    {"--fps", &StereoSource::fps}, {"--fov", &StereoSource::fov}, {"--tolerance", &StereoSource::tolerance_ms}};

/// An option without a value.
struct Flag {
  const char* option;
  bool StereoSource::*value;
};
constexpr Flag kFlags[] = {{"--rectified", &StereoSource::rectified}, {"--restarts", &StereoSource::restarts}};

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

bool is_source_line(const std::string& text) { return text.rfind("--", 0) == 0; }

StereoSource parse_source_line(const std::string& text, const std::string& folder, const std::string& file, int line) {
  StereoSource source;
  const auto words = words_of(text);
  const auto set = [&](const std::string& option, const std::string& value) {
    for (const auto& word : kWords)
      if (option == word.option) return source.*word.value = word.is_path ? in_folder(value, folder) : value, true;
    for (const auto& number : kNumbers)
      if (option == number.option) return source.*number.value = parse_number(value, file, line, option), true;
    return false;
  };
  for (std::size_t i = 0; i < words.size(); i += 2) {
    const auto* flag =
        std::find_if(std::begin(kFlags), std::end(kFlags), [&](const Flag& each) { return words[i] == each.option; });
    if (flag != std::end(kFlags)) {
      source.*flag->value = true;
      --i;
      continue;
    }
    const bool has_value = i + 1 < words.size();
    if (has_value && set(words[i], words[i + 1])) continue;
    std::string options;
    for (const auto& word : kWords) options += std::string(word.option) + " ";
    for (const auto& number : kNumbers) options += std::string(number.option) + " ";
    for (const auto& each : kFlags) options += std::string(each.option) + " ";
    fail(file, line, in_quotes(words[i]) + (has_value ? "" : " without a value"),
         "one of " + options + "with its value");
  }
  return source;
}

std::vector<std::string> source_words(const StereoSource& source) {
  std::vector<std::string> words;
  for (const auto& word : kWords)
    if (!(source.*word.value).empty()) words.insert(words.end(), {word.option, source.*word.value});
  for (const auto& number : kNumbers)
    if (source.*number.value != 0) words.insert(words.end(), {number.option, format_exact(source.*number.value)});
  for (const auto& flag : kFlags)
    if (source.*flag.value) words.emplace_back(flag.option);
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

}  // namespace quadedge::data
