#include "data/image_list.hpp"

#include <algorithm>
#include <cctype>
#include <optional>
#include <set>

#include "data/layout.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

bool is_digit(char letter) { return std::isdigit(static_cast<unsigned char>(letter)) != 0; }

/// The digits at `at`, without leading zeros.
std::string digits_at(const std::string& text, std::size_t& at) {
  std::string digits;
  for (; at < text.size() && is_digit(text[at]); ++at) {
    if (!digits.empty() || text[at] != '0') digits += text[at];
  }
  return digits;
}

/// Timestamp given by a name, if it can be one.
std::optional<std::int64_t> stamp_of_name(const std::string& stem, const std::string& file) {
  const bool is_number =
      !stem.empty() && std::all_of(stem.begin(), stem.end(), [](char c) { return is_digit(c) || c == '.'; });
  const auto points = std::count(stem.begin(), stem.end(), '.');
  if (!is_number || points > 1 || !is_digit(stem.front())) return std::nullopt;
  if (points == 1) return parse_seconds(stem, file, 1);
  switch (stem.size()) {
    case 19: return parse_nanoseconds(stem, file, 1);
    case 16: return parse_nanoseconds(stem + "000", file, 1);
    case 13: return parse_nanoseconds(stem + "000000", file, 1);
    default: return std::nullopt;
  }
}

/// folder/name, or the same file next to the folder; empty if neither exists.
std::string beside(const fs::path& folder, const char* name) {
  for (const auto& place : {folder / name, folder / ".." / name}) {
    std::error_code ignored;
    if (fs::exists(place, ignored)) return place.string();
  }
  return {};
}

}  // namespace

bool comes_before(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::string left = digits_at(a, i), right = digits_at(b, j);
      if (left.size() != right.size()) return left.size() < right.size();
      if (left != right) return left < right;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
    }
  }
  if (i < a.size() || j < b.size()) return i >= a.size();
  return a < b;  // leading zeros
}

std::vector<std::pair<std::int64_t, std::string>> read_image_list(const std::string& file) {
  std::vector<std::pair<std::int64_t, std::string>> list;
  std::set<std::int64_t> stamps;
  for (const auto& line : data_lines(file)) {
    const auto cells = split(line.text, ", \t");
    if (cells.size() != 2) fail(file, line.number, in_quotes(line.text), "timestamp [ns],filename");
    list.emplace_back(parse_nanoseconds(cells[0], file, line.number), cells[1]);
    if (!stamps.insert(list.back().first).second)
      fail(file, line.number, "timestamp " + cells[0] + " again", "each timestamp once");
    if (fs::path(cells[1]).filename() != cells[1] || cells[1] == "..")
      fail(file, line.number, in_quotes(cells[1]), "the name of an image in data/");
  }
  if (list.empty()) fail(file, "no image", "rows of timestamp [ns],filename");
  return list;
}

std::vector<std::int64_t> read_times(const std::string& file) {
  std::vector<std::int64_t> stamps;
  if (fs::path(file).extension() == ".csv") {
    for (const auto& row : read_image_list(file)) stamps.push_back(row.first);
    return stamps;
  }
  for (const auto& line : data_lines(file)) {
    const auto cells = split(line.text);
    if (cells.size() != 1) fail(file, line.number, in_quotes(line.text), "one time in seconds");
    const std::int64_t stamp = parse_seconds(cells[0], file, line.number);
    if (!stamps.empty() && stamp <= stamps.back())
      fail(file, line.number, "timestamp " + format_seconds(stamp) + " after " + format_seconds(stamps.back()),
           "increasing timestamps");
    stamps.push_back(stamp);
  }
  if (stamps.empty()) fail(file, "no timestamps", "one in seconds on every line");
  return stamps;
}

std::int64_t usual_period(const std::vector<std::int64_t>& stamps_ns) {
  std::vector<std::int64_t> periods;
  for (std::size_t i = 1; i < stamps_ns.size(); ++i) periods.push_back(stamps_ns[i] - stamps_ns[i - 1]);
  if (periods.empty()) return 0;
  const auto middle = periods.begin() + static_cast<std::ptrdiff_t>(periods.size() / 2);
  std::nth_element(periods.begin(), middle, periods.end());
  return *middle;
}

CameraImages list_images(const fs::path& folder) {
  CameraImages images;
  std::vector<std::string> names = image_names(folder);
  const std::string list = beside(folder, "data.csv"), times = beside(folder, "times.txt");
  if (!list.empty()) {
    images.stamps_from = list;
    for (const auto& [stamp, name] : read_image_list(list)) {
      images.stamps_ns.push_back(stamp);
      images.files.push_back((folder / name).string());
      if (!fs::is_regular_file(images.files.back()))
        fail(images.files.back(), "no such file", "an image that " + list + " lists");
    }
    return images;
  }
  std::sort(names.begin(), names.end(), comes_before);
  for (const auto& name : names) images.files.push_back((folder / name).string());
  if (!times.empty()) {
    images.stamps_from = times;
    images.stamps_ns = read_times(times);
    if (images.stamps_ns.size() != images.files.size()) {
      fail(times, counted(images.stamps_ns.size(), "time"),
           "one per image, for the " + counted(images.files.size(), "image") + " in " + folder.string());
    }
    return images;
  }
  for (const auto& file : images.files) {
    const auto stamp = stamp_of_name(fs::path(file).stem().string(), file);
    if (!stamp) return {images.files, {}, {}};
    images.stamps_ns.push_back(*stamp);
  }
  images.stamps_from = "the names in " + folder.string();
  return images;
}

}  // namespace quadedge::data
