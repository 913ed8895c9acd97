/// \file test_copies_in_flight.cpp  Host memory outlives the copies that use it, even after an exception; results read
/// in one copy.
#include "device/buffer.hpp"
#include "device/device_edges.hpp"
#include "frontends.hpp"

using namespace quadedge;

namespace {

/// Delays everything that is enqueued after it.
class Gate {
 public:
  explicit Gate(opencl::Context& context) : event_(context.context()) {
    std::vector<cl::Event> waits{event_};
    context.queue().enqueueMarkerWithWaitList(&waits);
    context.queue().flush();
    opener_ = std::thread([this] {
      std::this_thread::sleep_for(std::chrono::milliseconds(300));
      open_ = true;
      event_.setStatus(CL_COMPLETE);
    });
  }
  ~Gate() { opener_.join(); }
  bool is_open() const { return open_; }

 private:
  cl::UserEvent event_;
  std::atomic<bool> open_{false};
  std::thread opener_;
};

}  // namespace

TEST_CASE("copies: a block left by an exception waits for its copies", "[device]") {
  for (const auto& index : all_devices()) {
    Device device(index);
    auto& context = *device.context();
    opencl::Buffer<cl_int> buffer(context, 1000);
    buffer.write(std::vector<cl_int>(1000, 7).data(), 1000);
    std::vector<cl_int> values(1000, 0);
    const Gate gate(context);
    try {
      const opencl::CopyGuard guard(context);
      buffer.read_later(values.data(), values.size());
      throw DataError("something else");
    } catch (const DataError&) {
      CHECK(gate.is_open());
      CHECK(values == std::vector<cl_int>(1000, 7));
    }
  }
}

TEST_CASE("copies: a destroyed buffer waits for its copies", "[device]") {
  Device device(all_devices().front());
  auto& context = *device.context();
  std::vector<cl_int> values(1000, 0);
  auto buffer = std::make_unique<opencl::Buffer<cl_int>>(context, 1000);
  buffer->write(std::vector<cl_int>(1000, 7).data(), 1000);
  const Gate gate(context);
  buffer->read_later(values.data(), values.size());
  buffer.reset();
  CHECK(gate.is_open());
  CHECK(values == std::vector<cl_int>(1000, 7));
}

TEST_CASE("copies: images and predictions are no longer in use when the loss of the device is reported", "[device]") {
  const matching::RenderedScene scene("room", 161, 97, 2);
  const auto search = [](const auto& base) { return matching::search_around(base->edges, 12); };
  for (const auto& index : all_devices()) {
    for (const auto* type : {"cpu", "gpu"}) {
      opencl::DeviceLimits limits;
      limits.type = type;
      std::size_t before_first = 0, after_match = 0;
      {
        Device device = opencl::open_limited(index, kept_programs(), limits);
        const auto frontend = frontend::make_frontend(scene.rig, device, scene.config);
        before_first = device.context()->traffic().launches;
        const auto base = frontend->process(scene.frame(0));
        frontend->process(scene.frame(1));
        frontend->match(*base, search(base));
        after_match = device.context()->traffic().launches;
      }
      DYNAMIC_SECTION("images, " << type) {
        limits.launches = before_first + 1;
        Device device = opencl::open_limited(index, kept_programs(), limits);
        const auto frontend = frontend::make_frontend(scene.rig, device, scene.config);
        const Gate gate(*device.context());
        CHECK_THROWS_AS(frontend->process(scene.frame(0)), DeviceError);
        CHECK(gate.is_open());
      }
      DYNAMIC_SECTION("predictions, " << type) {
        limits.launches = after_match - 1;  // GPUs index the points before the predictions are copied
        Device device = opencl::open_limited(index, kept_programs(), limits);
        const auto frontend = frontend::make_frontend(scene.rig, device, scene.config);
        const auto base = frontend->process(scene.frame(0));
        frontend->process(scene.frame(1));
        const Gate gate(*device.context());
        CHECK_THROWS_AS(frontend->match(*base, search(base)), DeviceError);
        CHECK(gate.is_open());
      }
    }
  }
}

TEST_CASE("read-back: the host sees the buffer's content, on CPUs by mapping it and elsewhere by a copy", "[device]") {
  for (const auto& index : all_devices()) {
    for (const auto* type : {"cpu", "gpu"}) {
      opencl::DeviceLimits limits;
      limits.type = type;
      Device device = opencl::open_limited(index, {}, limits);
      auto& context = *device.context();
      opencl::ReadBack read_back;
      for (const std::size_t size : {10U, 5000U, 20U}) {
        opencl::Buffer<cl_int> buffer(context, size);
        std::vector<cl_int> values(size), seen;
        for (const cl_int first : {3, -8}) {  // the buffer can be written again afterwards
          std::iota(values.begin(), values.end(), first);
          buffer.write(values.data(), size);
          const std::size_t waits = context.traffic().waits;
          read_back.read(context, buffer, size, [&](const cl_int* found) { seen.assign(found, found + size); });
          CHECK(seen == values);
          CHECK(context.traffic().waits == waits + 1);
        }
      }
    }
  }
}
