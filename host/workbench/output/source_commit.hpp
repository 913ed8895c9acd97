#pragma once
/// \file source_commit.hpp  The commit of the program, which belongs to every measurement. CMake writes its source.

namespace quadedge::report {

/// Commit that this program was built from, with a "+" where the sources had changed; empty when built outside a
/// checkout.
const char* source_commit();

}  // namespace quadedge::report
