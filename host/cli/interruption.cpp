#include "cli/interruption.hpp"

#include <cstdlib>

namespace quadedge::cli {
namespace {

volatile std::sig_atomic_t received = 0;  // a signal handler can reach nothing but a global variable

void note_signal(int number) { received = number; }

}  // namespace

Interruption::Interruption() {
  received = 0;
  struct sigaction action {};
  action.sa_handler = note_signal;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    sigaction(kSignals[i], nullptr, &before_[i]);
    if (before_[i].sa_handler != SIG_IGN) sigaction(kSignals[i], &action, nullptr);
  }
}

Interruption::~Interruption() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
}

int Interruption::signal() const { return received; }

void Interruption::end_process() const {
  struct sigaction standard {};
  standard.sa_handler = SIG_DFL;
  sigaction(received, &standard, nullptr);
  raise(received);
  std::abort();
}

}  // namespace quadedge::cli
