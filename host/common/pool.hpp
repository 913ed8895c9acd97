#pragma once
/// \file pool.hpp  Objects that keep their memory from frame to frame.

#include <memory>
#include <utility>
#include <vector>

namespace quadedge {

/// Objects that are given back instead of destroyed. Must outlive all that it hands out; one thread at a time.
/// \tparam T has clear(), which empties it and keeps its memory
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

  /// What was given back longest ago, or a new one: so each step of a frame finds the memory that the same step of the
  /// frame before has left.
  Handle take() {
    if (spare_.empty()) return Handle(new T(), GiveBack{this});
    Handle object(spare_.front().release(), GiveBack{this});
    spare_.erase(spare_.begin());
    return object;
  }

 private:
  std::vector<std::unique_ptr<T>> spare_;
};

}  // namespace quadedge
