#pragma once
/// \file number_text.hpp  Numbers as tables for people print them.

#include <string>

namespace quadedge::report {

/// Four significant digits, at most nine decimals, never an exponent (0 for what is smaller); a dash for a value that
/// does not exist.
std::string significant(double value);

/// The value, and in brackets by how much it differs from `baseline`, with its sign and as many decimals as the value;
/// "=" where these decimals show no difference. `separator` stands between the two.
std::string with_difference(double value, double baseline, const std::string& separator = " ");

/// "58 / 86 (67.4 %)"; a dash for none of none.
std::string share_text(int part, int whole);

}  // namespace quadedge::report
