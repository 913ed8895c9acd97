#pragma once
/// \file printed.hpp  Numbers as text, independent of the locale of the process.

#include <string>

namespace quadedge {

/// As std::snprintf() formats it in the locale "C", with a decimal point: programs that use this library, such as those
/// with Qt or GTK, set locales with a decimal comma.
[[gnu::format(printf, 1, 2)]] std::string printed(const char* format, ...);

}  // namespace quadedge
