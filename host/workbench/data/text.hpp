#pragma once
/// \file text.hpp  Strict parsing of the small text files of recorded datasets. Error messages state file and line,
/// what was found and what was expected. Independent of the locale.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace quadedge::data {

/// \throws DataError "FILE: found FOUND, expected EXPECTED"; with a line number "FILE:LINE: ...".
[[noreturn]] void fail(const std::string& file, const std::string& found, const std::string& expected);
[[noreturn]] void fail(const std::string& file, int line, const std::string& found, const std::string& expected);

/// \throws DataError about a timestamp [ns] that is not later than the one before it.
[[noreturn]] void fail_order(const std::string& file, int line, std::int64_t stamp, std::int64_t before);

/// "a folder", "a pipe", "a device" or "a socket"; empty for regular files and if nothing exists. Reading a pipe may
/// block, and a device may never end.
std::string irregular_kind(const std::string& file);

/// Reads a regular file of at most 2 GiB. \throws DataError if it is missing, larger, of another kind, or unreadable
std::string read_bytes(const std::string& file);

/// Reads a text file, without the UTF-8 byte order mark that some editors add. UTF-16, as Windows' PowerShell writes
/// what a program prints, is read as its ASCII characters. \throws DataError as read_bytes()
std::string read_text(const std::string& file);

/// One line of a text file, without the line ending.
struct Line {
  int number = 0;  ///< from 1
  std::string text;
};

/// All lines. Both kinds of line endings are supported. \throws DataError as read_text()
std::vector<Line> text_lines(const std::string& file);

/// Whether a line is neither empty nor a comment, which starts with '#'.
bool has_data(const Line& line);

/// The lines with data: not empty and not starting with '#'. \throws DataError as read_text()
std::vector<Line> data_lines(const std::string& file);

/// The same without a first line that names the columns. \throws DataError as read_text()
std::vector<Line> table_lines(const std::string& file);

/// The non-empty parts between any of the `separators`.
std::vector<std::string> split(std::string_view text, std::string_view separators = " \t");

/// The text in quotes for a message; long texts are shortened, unprintable bytes replaced.
std::string in_quotes(std::string_view text);

/// "1 frame", "3 frames".
std::string counted(std::size_t count, const std::string& noun);
std::string counted(int count, const std::string& noun);

/// The one or two files of an option, separated by a comma: by one that leaves two existing files, else by the first.
/// An existing file whose name contains a comma is one file.
std::vector<std::string> file_list(const std::string& files);

/// A word of a command line for a shell: in single quotes where it needs some.
std::string shell_word(const std::string& word);

/// Parses a finite number that fills the whole token. \throws DataError; `what` names the quantity
double parse_number(const std::string& token, const std::string& file, int line, const std::string& what);

/// Parses an integer from `low` to `high`, including forms like "752.0". \throws DataError; `what` names the quantity
int parse_whole(const std::string& token, const std::string& file, int line, const std::string& what, int low,
                int high);

/// Parses exactly `count` finite numbers on one line. `what` describes the row, e.g. "timestamp tx ty tz qx qy qz qw".
std::vector<double> parse_row(const Line& line, const std::string& file, std::size_t count, const std::string& what);

/// Converts decimal seconds (possibly with an exponent) to the nearest nanosecond, exactly up to 4.6e9 s.
std::int64_t parse_seconds(const std::string& token, const std::string& file, int line);

/// Parses integer nanoseconds. \throws DataError
std::int64_t parse_nanoseconds(const std::string& token, const std::string& file, int line);

/// Seconds with nine decimals, exactly.
std::string format_seconds(std::int64_t nanoseconds);

/// A number with so many decimals.
std::string format_fixed(double value, int decimals);

/// A double with 17 significant digits, which reads back as the same value.
std::string format_exact(double value);

}  // namespace quadedge::data
