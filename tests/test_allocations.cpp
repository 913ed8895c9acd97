#include <new>

#include "frontends.hpp"

namespace {

/// Arrays that grow with the image or its edges are larger; those of a frame's result are smaller.
constexpr std::size_t kLarge = 4096;
std::atomic<bool> counting{false};
std::atomic<int> allocations{0};

void* allocate(std::size_t size) {
  if (size >= kLarge && counting) ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) { return allocate(size); }
void* operator new[](std::size_t size) { return allocate(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

TEST_CASE("odometry: tracking allocates no more arrays once every buffer has reached its final size", "[device]") {
  matching::RenderedScene scene("room", 240, 150, 8);
  scene.config.temporal.global_edges = 0;  // the global search, in every tenth frame, returns new arrays
  for (const auto& name : all_devices()) {
    quadedge::Device device(name, kept_programs());
    quadedge::StereoOdometry odometry(scene.rig, device, scene.config);
    std::int64_t stamp = 0;
    const auto is_tracked = [&](std::size_t i) {
      quadedge::StereoFrame frame = scene.frame(i);
      frame.stamp_ns = ++stamp;
      return odometry.track(frame).status == quadedge::FrameStatus::tracked ? 1 : 0;
    };
    // Back and forth, so that the same motions recur with other keyframes.
    const auto there_and_back = [&] {
      int tracked = 0;
      for (std::size_t i = 0; i + 1 < 8; ++i) tracked += is_tracked(i);
      for (std::size_t i = 7; i > 0; --i) tracked += is_tracked(i);
      return tracked;
    };
    counting = true;
    there_and_back();
    CHECK(allocations > 50);  // they are counted
    for (int cycle = 0; cycle < 4; ++cycle) there_and_back();
    allocations = 0;
    const int tracked = there_and_back();
    counting = false;
    CHECK(tracked == 14);
    CHECK(allocations == 0);
  }
}
