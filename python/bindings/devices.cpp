/// \file devices.cpp  OpenCL devices (include/quadedge/device.hpp).

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arguments.hpp"
#include "quadedge/threads.hpp"

namespace quadedge::python {

std::string device_choice(nb::handle device) {
  if (std::string choice; nb::try_cast(device, choice)) return choice;
  if (PyIndex_Check(device.ptr()) && !nb::isinstance<nb::bool_>(device))
    return nb::cast<std::string>(nb::str(nb::int_(device)));
  throw nb::type_error(
      "device: expected \"auto\", \"cpu\", \"gpu\", \"reference\", an index of devices(), or a part of a device's "
      "name");
}

DeviceArgument::DeviceArgument(nb::handle device) {
  if (nb::try_cast(device, shared_) && shared_ != nullptr) return;
  const std::string choice = device_choice(device);
  const ReleasedGil released;
  own_.reset(new SharedDevice{Device(choice), {}});
  shared_ = own_.get();
}

void bind_devices(nb::module_& module) {
  nb::class_<DeviceInfo>(module, "DeviceInfo", "Properties of a device.")
      .def_ro("index", &DeviceInfo::index,
              "Index that ``device=`` takes, as ``quadedge devices`` prints it; -1 for the plain C++ reference.")
      .def_ro("platform", &DeviceInfo::platform)
      .def_ro("name", &DeviceInfo::name)
      .def_ro("driver", &DeviceInfo::driver, "Version of the driver.")
      .def_ro("opencl", &DeviceInfo::opencl, "Version of OpenCL.")
      .def_ro("type", &DeviceInfo::type, "cpu, gpu, accelerator or reference.")
      .def_ro("compute_units", &DeviceInfo::compute_units)
      .def_ro("memory_bytes", &DeviceInfo::memory_bytes, "Global memory [bytes].")
      .def("__repr__", [](const DeviceInfo& info) {
        return "<DeviceInfo " + std::to_string(info.index) + ": " + info.type + ", " + info.name + ">";
      });

  nb::class_<SharedDevice>(module, "Device",
                           "An opened device. Pass one to several calls of detect_edges() and match() to build its\n"
                           "kernels only once. Threads may share a Device; their calls are serialised.")
      .def(
          "__init__",
          [](SharedDevice* self, nb::handle device) {
            const std::string choice = device_choice(device);
            const ReleasedGil released;
            new (self) SharedDevice{Device(choice), {}};
          },
          nb::arg("choice").none() = "auto", nb::sig("def __init__(self, choice: str | int = 'auto') -> None"),
          "choice: \"auto\" (first GPU, else first CPU), \"cpu\", \"gpu\", \"reference\" (plain C++, slow, without\n"
          "OpenCL), an index of ``devices()``, or a part of a platform's or device's name.\n\n"
          "Raises DeviceError, which lists the devices, when none matches; TypeError for anything but str and int.")
      .def_prop_ro("info", [](const SharedDevice& self) { return self.device.info(); });

  module.def("limit_threads", &limit_threads, "count"_a,
             "At most ``count`` threads for loops and OpenCL on CPUs. 0: all, each of PoCL's stays on one processor.\n"
             "To be called before the first device is opened. Results do not depend on it. Raises UsageError below 0.");
  module.def("devices", &list_devices,
             "All OpenCL devices in a fixed order; empty without a driver or without libOpenCL.so.1.\n\n"
             "Raises DeviceError in a process that was forked after OpenCL had been used.");
}

}  // namespace quadedge::python
