#pragma once
/// \file released_gil.hpp  Python's global interpreter lock, released while the library works.

#include <nanobind/nanobind.h>

namespace quadedge::python {

/// Releases the lock while it lives. A thread that takes the lock back while Python ends would be ended inside C++, and
/// the process aborted with it: Python ends only after the work of other threads, and these begin no more.
class ReleasedGil {
 public:
  ReleasedGil();
  ~ReleasedGil();
  ReleasedGil(const ReleasedGil&) = delete;
  ReleasedGil& operator=(const ReleasedGil&) = delete;

 private:
  PyThreadState* state_;
};

/// Has Python wait at its end for work that goes on in other threads.
void wait_for_work_at_exit();

}  // namespace quadedge::python
