/// \file image_list.cpp  Finds the unit of integer stamps by their rate; pairs images mutually nearest in time.
#include "data/image_list.hpp"

#include <algorithm>
#include <cctype>
#include <ctime>
#include <iomanip>
#include <map>
#include <set>
#include <sstream>

#include "common/numeric.hpp"
#include "common/printed.hpp"
#include "data/layout.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

constexpr std::int64_t kShortestPeriod = 1'000'000, kLongestPeriod = 5'000'000'000;  // ns: 1000 and 0.2 Hz

bool are_digits(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

bool is_integer_stamp(const std::string& text) {
  constexpr std::size_t kFewestDigits = 10, kMostDigits = 19;
  return are_digits(text) && text[0] != '0' && text.size() >= kFewestDigits && text.size() <= kMostDigits;
}

bool are_decimal_seconds(const std::string& text) {
  const std::size_t point = text.find('.');
  return point != std::string::npos && are_digits(text.substr(0, point)) && are_digits(text.substr(point + 1));
}

/// Nanoseconds per unit of integer stamps; 0 if no unit gives a plausible rate.
std::int64_t unit_of(const std::vector<std::int64_t>& numbers, std::size_t digits) {
  const std::int64_t by_length = digits >= 18 ? 1 : digits >= 15 ? 1'000 : 1'000'000;
  std::vector<std::int64_t> candidates = {by_length, 1, 1'000, 1'000'000};
  const std::int64_t step = usual_period(numbers);
  if (step == 0) return digits == 19 || digits == 16 || digits == 13 ? by_length : 0;
  for (const std::int64_t unit : candidates) {
    constexpr std::int64_t kLargest = INT64_MAX;
    if (step > kLongestPeriod / unit || step < (kShortestPeriod + unit - 1) / unit) continue;
    if (*std::max_element(numbers.begin(), numbers.end()) <= kLargest / unit) return unit;
  }
  return *std::max_element(numbers.begin(), numbers.end()) <= INT64_MAX / by_length ? by_length : 1;
}

std::optional<std::vector<std::int64_t>> integer_stamps(const std::vector<std::string>& words,
                                                        const std::string& file) {
  if (!std::all_of(words.begin(), words.end(), is_integer_stamp)) return std::nullopt;
  std::vector<std::int64_t> numbers;
  std::size_t digits = 0;
  for (const std::string& word : words) {
    numbers.push_back(parse_nanoseconds(word, file, static_cast<int>(numbers.size()) + 1));
    digits = std::max(digits, word.size());
  }
  std::vector<std::int64_t> sorted = numbers;
  std::sort(sorted.begin(), sorted.end());
  const std::int64_t unit = unit_of(sorted, digits);
  if (unit == 0) return std::nullopt;
  for (std::int64_t& number : numbers) number *= unit;
  return numbers;
}

/// "2011-09-26 13:02:25.967790592", as UTC. \throws DataError
std::int64_t dated_stamp(const std::vector<std::string>& words, const std::string& file, int line) {
  std::tm whole_minutes{};
  std::string seconds;
  std::istringstream text(words[0] + " " + words[1]);
  if (!(text >> std::get_time(&whole_minutes, "%Y-%m-%d %H:%M:") >> seconds) || whole_minutes.tm_year < 70)
    fail(file, line, in_quotes(text.str()), "YYYY-MM-DD HH:MM:SS.fraction");
  return timegm(&whole_minutes) * 1'000'000'000 + parse_seconds(seconds, file, line);
}

/// The rows of a file of times.
struct TimeRows {
  std::vector<std::int64_t> stamps_ns;
  std::vector<std::string> names;  ///< image names without extension, one per row; empty if the rows state none
};

/// As read_times(), but for data.csv.
TimeRows read_time_rows(const std::string& file, bool restarts = false) {
  TimeRows rows;
  const std::vector<Line> lines = table_lines(file);
  if (lines.empty()) fail(file, "no timestamps", "one in seconds on every line");
  std::vector<std::string> words_of_times;
  for (const Line& line : lines) {
    const auto words = split(line.text, ", \t\r");
    if (words.size() == 2 && words[0].find('-') != std::string::npos) {
      rows.stamps_ns.push_back(dated_stamp(words, file, line.number));
    } else if (words.size() == 1) {
      words_of_times.push_back(words[0]);
    } else if (words.size() <= 3) {
      rows.names.push_back(words[0]);
      words_of_times.push_back(words[1]);
    } else {
      fail(file, line.number, in_quotes(line.text), "one time in seconds, or \"name seconds exposure\"");
    }
  }
  if (words_of_times.size() + rows.stamps_ns.size() != lines.size() ||
      (!words_of_times.empty() && !rows.stamps_ns.empty()) ||
      (!rows.names.empty() && rows.names.size() != lines.size()))
    fail(file, "rows of different formats", "one time in seconds, or \"name seconds exposure\", in every row");
  if (auto stamps = integer_stamps(words_of_times, file); stamps && !words_of_times.empty()) {
    rows.stamps_ns = std::move(*stamps);
  } else {
    for (std::size_t i = 0; i < words_of_times.size(); ++i)
      rows.stamps_ns.push_back(parse_seconds(words_of_times[i], file, lines[i].number));
  }
  for (std::size_t i = 1; i < rows.stamps_ns.size(); ++i) {
    const std::int64_t step = rows.stamps_ns[i] - rows.stamps_ns[i - 1];
    if (step > 0 || (step < 0 && restarts)) continue;
    fail_order(file, lines[i].number, rows.stamps_ns[i], rows.stamps_ns[i - 1]);
  }
  return rows;
}

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

std::optional<std::vector<std::int64_t>> stamps_of_names(const std::vector<std::string>& stems,
                                                         const std::string& folder) {
  if (!std::all_of(stems.begin(), stems.end(), are_decimal_seconds)) return integer_stamps(stems, folder);
  std::vector<std::int64_t> stamps;
  for (const std::string& stem : stems) stamps.push_back(parse_seconds(stem, folder, 1));
  return stamps;
}

StampPairs pair_stamps(const std::vector<std::int64_t>& left_ns, const std::vector<std::int64_t>& right_ns,
                       std::int64_t tolerance_ns) {
  using Indexed = std::vector<std::pair<std::int64_t, std::size_t>>;
  const auto in_order = [](const std::vector<std::int64_t>& stamps) {
    Indexed indexed;
    for (std::size_t i = 0; i < stamps.size(); ++i) indexed.emplace_back(stamps[i], i);
    std::sort(indexed.begin(), indexed.end());
    return indexed;
  };
  const auto nearest = [](const Indexed& stamps, std::int64_t stamp) {
    auto after = std::lower_bound(stamps.begin(), stamps.end(), std::make_pair(stamp, std::size_t{0}));
    const bool takes_before =
        after == stamps.end() || (after != stamps.begin() && stamp - std::prev(after)->first <= after->first - stamp);
    return takes_before ? std::prev(after) : after;
  };
  StampPairs result;
  const Indexed left = in_order(left_ns), right = in_order(right_ns);
  std::vector<std::int64_t> sorted;
  for (const auto& entry : left) sorted.push_back(entry.first);
  const std::int64_t half = (usual_period(sorted) - 1) / 2;
  const std::int64_t tolerance = tolerance_ns > 0 ? tolerance_ns : half > 0 ? half : INT64_MAX;
  for (auto entry = left.begin(); entry != left.end() && !right.empty(); ++entry) {
    const auto partner = nearest(right, entry->first);
    const std::int64_t difference = std::abs(partner->first - entry->first);
    if (nearest(left, partner->first) != entry || difference > tolerance) continue;
    result.pairs.emplace_back(entry->second, partner->second);
    result.largest_difference_ns = std::max(result.largest_difference_ns, difference);
  }
  std::sort(result.pairs.begin(), result.pairs.end());
  return result;
}

std::int64_t usual_period(const std::vector<std::int64_t>& stamps_ns) {
  std::vector<std::int64_t> periods;
  for (std::size_t i = 1; i < stamps_ns.size(); ++i) periods.push_back(stamps_ns[i] - stamps_ns[i - 1]);
  return periods.empty() ? 0 : upper_median(periods);
}

std::string rate_complaint(const std::vector<std::int64_t>& stamps_ns) {
  const std::int64_t period = usual_period(stamps_ns);
  if (period <= 0 || (period >= kShortestPeriod && period <= kLongestPeriod)) return {};
  return printed(
      "the timestamps have a rate of %.4g Hz, expected 0.2 to 1000 Hz: another unit? --fps N or --times FILE replaces "
      "them",
      1e9 / static_cast<double>(period));
}

std::string number_jump(const std::vector<std::string>& files) {
  std::vector<std::int64_t> numbers;
  for (const std::string& file : files) {
    const std::string stem = fs::path(file).stem().string();
    const std::size_t end = stem.find_last_of("0123456789") + 1;
    std::size_t begin = end;
    while (begin > 0 && std::isdigit(static_cast<unsigned char>(stem[begin - 1])) != 0) --begin;
    constexpr std::size_t kMostDigits = 18;
    if (begin == end || end - begin > kMostDigits) return {};
    numbers.push_back(std::stoll(stem.substr(begin, end - begin)));
  }
  const std::int64_t usual = usual_period(numbers);
  std::size_t widest = 1;
  for (std::size_t i = 1; i < numbers.size(); ++i)
    if (numbers[i] - numbers[i - 1] > numbers[widest] - numbers[widest - 1]) widest = i;
  if (usual <= 0 || numbers.size() < 3 || numbers[widest] - numbers[widest - 1] <= 2 * usual) return {};
  const auto name = [&](std::size_t i) { return fs::path(files[i]).filename().string(); };
  return "the numbers of the images jump from " + name(widest - 1) + " to " + name(widest) + ", usually by " +
         std::to_string(usual) +
         ": were images lost, or did the counter restart? Then the later images come first: use names that continue, "
         "or --times FILE";
}

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
