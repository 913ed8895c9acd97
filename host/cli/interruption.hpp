#pragma once
/// \file interruption.hpp  Ctrl-C and the system's wish to end: asked for between steps instead of cutting through one.

#include <array>
#include <csignal>

namespace quadedge::cli {

/// While it lives, SIGINT, SIGTERM and SIGHUP are noted instead of ending the process, each once: the second Ctrl-C
/// ends it at once. (Those that are ignored, as under nohup, stay ignored.) One at a time.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// The signal received; 0: none.
  int signal() const;
  /// Ends this process by the signal received, so that its parent sees why.
  [[noreturn]] void end_process() const;

 private:
  static constexpr std::array<int, 3> kSignals = {SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, 3> before_{};
};

}  // namespace quadedge::cli
