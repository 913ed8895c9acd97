#pragma once
/// \file printed.hpp  Numbers as text, independent of the locale of the process, and lists of words.

#include <string>
#include <vector>

namespace quadedge {

/// As std::snprintf() formats it in the locale "C", with a decimal point: programs that use this library, such as those
/// with Qt or GTK, set locales with a decimal comma.
[[gnu::format(printf, 1, 2)]] std::string printed(const char* format, ...);

/// The words one after the other, with `between` between them.
std::string joined(const std::vector<std::string>& words, const char* between = ", ");

}  // namespace quadedge
