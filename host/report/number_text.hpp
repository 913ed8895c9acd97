#pragma once
/// \file number_text.hpp  Numbers as tables for people print them.

#include <string>

namespace quadedge::report {

/// Four significant digits, at most nine decimals, never an exponent (0 for what is smaller); a dash for a value that
/// does not exist.
std::string significant(double value);

/// "58 / 86 (67.4 %)"; a dash for none of none.
std::string share_text(int part, int whole);

}  // namespace quadedge::report
