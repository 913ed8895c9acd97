#pragma once
/// \file standard_streams.hpp  Standard input, output and error, where the caller has closed them.

namespace quadedge::cli {

/// Replaces closed standard streams, so that no file of the program gets their numbers, and with
/// them what is printed. Input is at its end, errors go nowhere, and printing fails as it does into a closed stream.
/// Before anything opens a file.
void occupy_standard_streams();

}  // namespace quadedge::cli
