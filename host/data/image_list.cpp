#include "data/image_list.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "data/layout.hpp"
#include "data/stamps.hpp"
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

/// folder/name, or the same file next to the folder; empty if neither exists.
std::string beside(const fs::path& folder, const char* name) {
  for (const auto& place : {folder / name, folder / ".." / name}) {
    std::error_code ignored;
    if (fs::exists(place, ignored)) return place.string();
  }
  return {};
}

/// Gives every image its time: by its name where the rows state names, otherwise in order.
void take_times(const TimeRows& rows, const std::string& file, const fs::path& folder, CameraImages& images) {
  std::map<std::string, std::int64_t> by_name;
  for (std::size_t i = 0; i < rows.names.size(); ++i)
    by_name[fs::path(rows.names[i]).stem().string()] = rows.stamps_ns[i];
  for (const std::string& image : images.files) {
    const auto found = by_name.find(fs::path(image).stem().string());
    if (found != by_name.end()) images.stamps_ns.push_back(found->second);
  }
  if (images.stamps_ns.size() == images.files.size()) return;
  if (!images.stamps_ns.empty()) {
    fail(file, "names of " + counted(images.stamps_ns.size(), "image"),
         "all " + std::to_string(images.files.size()) + " in " + folder.string() + ", or none of them");
  }
  images.stamps_ns = rows.stamps_ns;
  if (images.stamps_ns.size() != images.files.size()) {
    fail(file, counted(images.stamps_ns.size(), "time"),
         "one per image, for the " + counted(images.files.size(), "image") + " in " + folder.string());
  }
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
  for (const auto& line : table_lines(file)) {
    const auto cells = split(line.text, ", \t");
    if (cells.size() != 2) fail(file, line.number, in_quotes(line.text), "timestamp [ns],filename");
    const fs::path name = cells[1], place = name.parent_path();  // some lists state cam0/data/NAME
    if ((!place.empty() && place.filename() != "data") || place.string().find("..") != std::string::npos)
      fail(file, line.number, in_quotes(cells[1]), "the name of an image in data/");
    list.emplace_back(parse_nanoseconds(cells[0], file, line.number), name.filename().string());
    if (!stamps.insert(list.back().first).second)
      fail(file, line.number, "timestamp " + cells[0] + " again", "each timestamp once");
    if (list.back().second == ".." || list.back().second.empty())
      fail(file, line.number, in_quotes(cells[1]), "the name of an image in data/");
  }
  if (list.empty()) fail(file, "no image", "rows of timestamp [ns],filename");
  return list;
}

std::vector<std::int64_t> read_times(const std::string& file, bool restarts) {
  if (fs::path(file).extension() != ".csv") return read_time_rows(file, restarts).stamps_ns;
  std::vector<std::int64_t> stamps;
  for (const auto& row : read_image_list(file)) stamps.push_back(row.first);
  return stamps;
}

/// Whether a data.csv lists images: an IMU's has other columns.
bool lists_images(const std::string& file) {
  const auto lines = table_lines(file);
  return lines.empty() || split(lines[0].text, ", \t").size() <= 2;
}

CameraImages list_images(const fs::path& folder, bool needs_stamps) {
  CameraImages images;
  std::vector<std::string> names = image_names(folder);
  const std::string list = beside(folder, "data.csv"), times = beside(folder, "times.txt");
  if (needs_stamps && !list.empty() && lists_images(list)) {
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
  if (!needs_stamps) return images;
  if (!times.empty()) {
    images.stamps_from = times;
    take_times(read_time_rows(times), times, folder, images);
    return images;
  }
  std::vector<std::string> stems;
  for (const auto& file : images.files) stems.push_back(fs::path(file).stem().string());
  const auto stamps = stamps_of_names(stems, folder.string());
  if (const std::string rows = beside(folder, "timestamps.txt"); !stamps && !rows.empty()) {
    images.stamps_from = rows;  // of KITTI's raw drives
    take_times(read_time_rows(rows), rows, folder, images);
    return images;
  }
  if (!stamps) return images;
  images.stamps_ns = *stamps;
  images.stamps_from = "the names in " + folder.string();
  return images;
}

}  // namespace quadedge::data
