/// \file released_gil.cpp  Counts running work, for which the end of Python waits; later threads sleep forever.
#include "released_gil.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace quadedge::python {
namespace {

constexpr std::chrono::seconds kLongestWait{10};  // for work that never ends, such as reading a pipe

struct Work {
  std::mutex access;
  std::condition_variable changed;
  int running = 0;              ///< objects of ReleasedGil
  bool ends = false;            ///< whether Python ends
  bool was_waited_for = false;  ///< whether it goes on with its end
  std::thread::id ending_thread;

  bool must_stop() const { return ends && std::this_thread::get_id() != ending_thread; }
};

/// Lives longer than threads that stop.
Work& work() {
  static auto* all = new Work;
  return *all;
}

[[noreturn]] void stop() {
  for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
}

}  // namespace

ReleasedGil::ReleasedGil() : state_(PyEval_SaveThread()) {
  std::unique_lock<std::mutex> lock(work().access);
  if (!work().must_stop()) {
    ++work().running;
    return;
  }
  lock.unlock();
  stop();
}

ReleasedGil::~ReleasedGil() {
  std::unique_lock<std::mutex> lock(work().access);
  const bool is_late = work().must_stop() && work().was_waited_for;
  lock.unlock();
  if (is_late) stop();
  PyEval_RestoreThread(state_);
  lock.lock();
  --work().running;
  work().changed.notify_all();
}

void wait_for_work_at_exit() {
  const auto wait = [] {
    PyThreadState* state = PyEval_SaveThread();
    {
      std::unique_lock<std::mutex> lock(work().access);
      work().ends = true;
      work().ending_thread = std::this_thread::get_id();
      work().changed.wait_for(lock, kLongestWait, [] { return work().running == 0; });
      work().was_waited_for = true;
    }
    PyEval_RestoreThread(state);
  };
  nanobind::module_::import_("atexit").attr("register")(nanobind::cpp_function(wait));
}

}  // namespace quadedge::python
