/// \file text.cpp  Parses by std::from_chars(), which consumes whole tokens and ignores the locale.
#include "data/text.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <sstream>

#include "common/printed.hpp"
#include "quadedge/error.hpp"

namespace quadedge::data {

void fail(const std::string& file, const std::string& found, const std::string& expected) {
  throw DataError(file + ": found " + found + ", expected " + expected);
}

void fail(const std::string& file, int line, const std::string& found, const std::string& expected) {
  fail(file + ":" + std::to_string(line), found, expected);
}

void fail_order(const std::string& file, int line, std::int64_t stamp, std::int64_t before) {
  fail(file, line, "timestamp " + format_seconds(stamp) + " after " + format_seconds(before), "increasing timestamps");
}

std::string irregular_kind(const std::string& file) {
  std::error_code ignored;
  switch (std::filesystem::status(file, ignored).type()) {
    case std::filesystem::file_type::directory: return "a folder";
    case std::filesystem::file_type::fifo: return "a pipe";
    case std::filesystem::file_type::socket: return "a socket";
    case std::filesystem::file_type::block:
    case std::filesystem::file_type::character: return "a device";
    default: return {};
  }
}

std::string read_bytes(const std::string& file) {
  if (const std::string kind = irregular_kind(file); !kind.empty()) fail(file, kind, "a regular file");
  constexpr std::uintmax_t kLargestFile = std::uintmax_t{1} << 31;  // bytes
  std::error_code ignored;
  if (const auto size = std::filesystem::file_size(file, ignored); !ignored && size > kLargestFile)
    fail(file, std::to_string(size) + " bytes", "at most " + std::to_string(kLargestFile));
  std::FILE* stream = std::fopen(file.c_str(), "rb");
  if (stream == nullptr)
    fail(file, std::string("a file that cannot be opened (") + std::strerror(errno) + ")", "a readable file");
  std::string bytes;
  char buffer[1 << 16];
  for (std::size_t count; (count = std::fread(buffer, 1, sizeof buffer, stream)) > 0;) bytes.append(buffer, count);
  const bool broken = std::ferror(stream) != 0;
  std::fclose(stream);
  if (broken) fail(file, "a read error", "a readable file");
  return bytes;
}

std::string read_text(const std::string& file) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  std::string text = read_bytes(file);
  if (text.compare(0, kByteOrderMark.size(), kByteOrderMark) == 0) text.erase(0, kByteOrderMark.size());
  if (text.compare(0, 2, "\xFF\xFE") != 0) return text;
  std::string narrow;
  for (std::size_t i = 2; i + 1 < text.size(); i += 2) narrow += text[i + 1] == 0 ? text[i] : '?';
  return narrow;
}

std::vector<Line> text_lines(const std::string& file) {
  std::istringstream all(read_text(file));
  std::vector<Line> lines;
  for (std::string text; std::getline(all, text);) {
    if (!text.empty() && text.back() == '\r') text.pop_back();
    lines.push_back({static_cast<int>(lines.size()) + 1, std::move(text)});
  }
  return lines;
}

bool has_data(const Line& line) {
  const std::size_t first = line.text.find_first_not_of(" \t");
  return first != std::string::npos && line.text[first] != '#';
}

std::vector<Line> data_lines(const std::string& file) {
  std::vector<Line> lines = text_lines(file);
  lines.erase(std::remove_if(lines.begin(), lines.end(), [](const Line& line) { return !has_data(line); }),
              lines.end());
  return lines;
}

std::vector<Line> table_lines(const std::string& file) {
  std::vector<Line> lines = data_lines(file);
  const auto is_name = [](const std::string& cell) { return cell.find_first_of("0123456789") == std::string::npos; };
  if (!lines.empty() && is_name(lines[0].text.substr(0, lines[0].text.find(',')))) lines.erase(lines.begin());
  return lines;
}

std::vector<std::string> split(std::string_view text, std::string_view separators) {
  std::vector<std::string> pieces;
  for (std::size_t begin = text.find_first_not_of(separators); begin != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
    pieces.emplace_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(separators, end);
  }
  return pieces;
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::string result = "\"";
  for (const char character : text.substr(0, kLongest)) {
    result += character >= ' ' && character < 127 ? character : '?';
  }
  return result + (text.size() > kLongest ? "...\"" : "\"");
}

std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string counted(int count, const std::string& noun) { return counted(static_cast<std::size_t>(count), noun); }

std::vector<std::string> file_list(const std::string& files) {
  const auto exists = [](const std::string& file) {
    std::error_code ignored;
    return std::filesystem::exists(file, ignored);
  };
  const auto first = files.find(',');
  if (first == std::string::npos || exists(files)) return {files};
  for (auto comma = first; comma != std::string::npos; comma = files.find(',', comma + 1))
    if (exists(files.substr(0, comma)) && exists(files.substr(comma + 1)))
      return {files.substr(0, comma), files.substr(comma + 1)};
  return {files.substr(0, first), files.substr(first + 1)};
}

std::string shell_word(const std::string& word) {
  const bool is_plain = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c >= 0x80 ||
           std::string_view("-_./+:,=@%").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (is_plain) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

double parse_number(const std::string& token, const std::string& file, int line, const std::string& what) {
  const char* begin = token.data() + (token.size() > 1 && token[0] == '+' ? 1 : 0);
  const char* end = token.data() + token.size();
  double value = 0;
  const auto result = std::from_chars(begin, end, value);
  if (result.ec != std::errc() || result.ptr != end || !std::isfinite(value)) {
    fail(file, line, in_quotes(token), "a finite number (" + what + ")");
  }
  return value;
}

int parse_whole(const std::string& token, const std::string& file, int line, const std::string& what, int low,
                int high) {
  const double value = parse_number(token, file, line, what);
  if (value < low || value > high || value != std::floor(value)) {
    fail(file, line, in_quotes(token),
         "a whole number from " + std::to_string(low) + " to " + std::to_string(high) + " (" + what + ")");
  }
  return static_cast<int>(value);
}

std::vector<double> parse_row(const Line& line, const std::string& file, std::size_t count, const std::string& what) {
  const auto tokens = split(line.text);
  if (tokens.size() != count) {
    fail(file, line.number, std::to_string(tokens.size()) + " columns in " + in_quotes(line.text),
         std::to_string(count) + " (" + what + ")");
  }
  std::vector<double> values;
  for (const auto& token : tokens) values.push_back(parse_number(token, file, line.number, what));
  return values;
}

std::int64_t parse_seconds(const std::string& token, const std::string& file, int line) {
  static_assert(std::numeric_limits<long double>::digits >= 64, "nanoseconds of clocks need them");
  const std::string expected = "a time in seconds";
  parse_number(token, file, line, expected);  // checks that the token is a single decimal number
  long double seconds = 0;
  std::from_chars(token.data() + (token[0] == '+' ? 1 : 0), token.data() + token.size(), seconds);
  const long double nanoseconds = std::round(seconds * 1e9L);
  if (!(std::abs(nanoseconds) < 0x1p63L)) fail(file, line, in_quotes(token), expected + " below 9.2e9");
  return static_cast<std::int64_t>(nanoseconds);
}

std::int64_t parse_nanoseconds(const std::string& token, const std::string& file, int line) {
  std::int64_t value = 0;
  const char* end = token.data() + token.size();
  const auto result = std::from_chars(token.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end) fail(file, line, in_quotes(token), "a time in whole nanoseconds");
  return value;
}

std::string format_seconds(std::int64_t nanoseconds) {
  constexpr std::uint64_t kPerSecond = 1'000'000'000;
  const bool negative = nanoseconds < 0;
  const std::uint64_t magnitude =
      negative ? 0 - static_cast<std::uint64_t>(nanoseconds) : static_cast<std::uint64_t>(nanoseconds);
  return printed("%s%" PRIu64 ".%09" PRIu64, negative ? "-" : "", magnitude / kPerSecond, magnitude % kPerSecond);
}

std::string format_fixed(double value, int decimals) { return printed("%.*f", decimals, value); }

std::string format_exact(double value) {
  char buffer[40];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 17);
  return std::string(buffer, result.ptr);
}

}  // namespace quadedge::data
