#pragma once
/// \file page_maker.hpp  The pages of `report`, `batch` and `evaluate matching`, which the Python module
/// quadedge.report makes from the files that these commands write.

#include <string>
#include <vector>

#include "cli/interruption.hpp"

namespace quadedge::cli {

/// Starts `PYTHON -m quadedge.report ARGUMENTS`, without a shell, and waits for it. PYTHON is $QUADEDGE_PYTHON; where
/// that is not set, the first of `venv/bin/python3` beside the program (scripts/run.sh and scripts/test.sh make it) and
/// `python3` on PATH that has the module. If none has it, prints one line on standard error on how to install it.
/// Returns the module's exit code; ExitCode::usage where it is missing. After a signal, ends PYTHON, then this process.
int make_page(const std::vector<std::string>& arguments, const Interruption& interruption);

}  // namespace quadedge::cli
