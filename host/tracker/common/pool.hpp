#pragma once
/// \file pool.hpp  A pool of objects that keep their memory between frames.

#include <memory>
#include <utility>
#include <vector>

namespace quadedge {

/// Objects are returned instead of destroyed. The pool must outlive its objects; not thread-safe.
/// \tparam T has clear(), which empties the object and keeps its memory
template <class T>
class Pool {
 public:
  struct GiveBack {
    Pool* pool = nullptr;
    void operator()(T* object) const {
      object->clear();
      pool->spare_.emplace_back(object);
    }
  };
  using Handle = std::unique_ptr<T, GiveBack>;

  /// Returns the object that was returned longest ago, or a new one, so that each step of a frame reuses the memory of
  /// the same step in the previous frame.
  Handle acquire() {
    if (spare_.empty()) return Handle(new T(), GiveBack{this});
    Handle object(spare_.front().release(), GiveBack{this});
    spare_.erase(spare_.begin());
    return object;
  }

 private:
  std::vector<std::unique_ptr<T>> spare_;
};

}  // namespace quadedge
