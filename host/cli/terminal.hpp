#pragma once
/// \file terminal.hpp  What the user's terminal can do.

#include <string>

namespace quadedge::cli {

/// Whether a stream (STDERR_FILENO) is a terminal that understands escape codes: not with TERM=dumb, nor without TERM.
bool has_escape_codes(int stream);

/// Columns of the terminal that a stream goes to: COLUMNS if set, else the terminal's own value; 0: no terminal.
int terminal_width(int stream);

/// Help text in lines of at most `width` columns (0: as it is). A line that is too long goes on below its description,
/// the text after two blanks; lines of examples ("  quadedge ...") stay whole, so that they can be copied.
std::string wrapped(const std::string& text, int width);

}  // namespace quadedge::cli
