#pragma once
/// \file text.hpp  Strict reading of the small text files that come with recorded data: every complaint names the file,
/// the line, what was found and what was expected. Independent of the locale.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace quadedge::data {

/// \throws DataError "FILE: found FOUND, expected EXPECTED"; with a line number "FILE:LINE: ...".
[[noreturn]] void fail(const std::string& file, const std::string& found, const std::string& expected);
[[noreturn]] void fail(const std::string& file, int line, const std::string& found, const std::string& expected);

/// "a folder", "a pipe", "a device" or "a socket" for what is no regular file; empty for regular files and for nothing.
/// Reading a pipe can wait for ever, reading a device never end.
std::string irregular_kind(const std::string& file);

/// A whole regular file. \throws DataError when it is missing, of another kind, or cannot be read.
std::string read_bytes(const std::string& file);

/// A whole text file without the UTF-8 byte order mark that some editors put in front. \throws DataError as read_bytes.
std::string read_text(const std::string& file);

/// One line of a text file, without its line end.
struct Line {
  int number = 0;  ///< from 1
  std::string text;
};

/// The lines that hold data: not empty and not starting with '#'. Both kinds of line end. \throws DataError as
/// read_text.
std::vector<Line> data_lines(const std::string& file);

/// The non-empty pieces between any of `separators`.
std::vector<std::string> split(std::string_view text, std::string_view separators = " \t");

/// The text in quotes for a message, shortened where it is long, unprintable bytes replaced.
std::string in_quotes(std::string_view text);

/// A finite number that fills the whole token. \throws DataError; `what` names the quantity.
double parse_number(const std::string& token, const std::string& file, int line, const std::string& what);

/// A finite whole number from `low` to `high`, also one written "752.0". \throws DataError; `what` names the quantity.
int parse_whole(const std::string& token, const std::string& file, int line, const std::string& what, int low,
                int high);

/// Exactly `count` finite numbers on one line. `what` describes the row, e.g. "timestamp tx ty tz qx qy qz qw".
std::vector<double> parse_row(const Line& line, const std::string& file, std::size_t count, const std::string& what);

/// Decimal seconds (an exponent is allowed) to nanoseconds, exactly: digits below 1 ns are rounded half away from zero.
std::int64_t parse_seconds(const std::string& token, const std::string& file, int line);

/// Whole nanoseconds. \throws DataError.
std::int64_t parse_nanoseconds(const std::string& token, const std::string& file, int line);

/// Seconds with nine decimals, exactly.
std::string format_seconds(std::int64_t nanoseconds);

/// A double with 17 significant digits, which read back as the same double.
std::string format_exact(double value);

}  // namespace quadedge::data
