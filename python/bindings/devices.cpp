/// \file devices.cpp  What there is to compute on (include/quadedge/device.hpp).

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "device_argument.hpp"

namespace quadedge::python {

DeviceArgument::DeviceArgument(nb::handle device) {
  if (nb::try_cast(device, shared_) && shared_ != nullptr) return;
  std::string choice;
  if (!nb::try_cast(device, choice)) {
    throw nb::type_error("device: expected a text such as \"auto\" or \"reference\", or a Device");
  }
  const nb::gil_scoped_release released;
  own_.reset(new SharedDevice{Device(choice), {}});
  shared_ = own_.get();
}

void bind_devices(nb::module_& module) {
  nb::class_<DeviceInfo>(module, "DeviceInfo", "What a device says of itself.")
      .def_ro("index", &DeviceInfo::index,
              "Number that ``device=`` takes, as ``quadedge devices`` prints it; -1 for the plain C++ reference.")
      .def_ro("platform", &DeviceInfo::platform)
      .def_ro("name", &DeviceInfo::name)
      .def_ro("driver", &DeviceInfo::driver)
      .def_ro("opencl", &DeviceInfo::opencl, "Version of OpenCL.")
      .def_ro("type", &DeviceInfo::type, "cpu, gpu, accelerator or reference.")
      .def_ro("compute_units", &DeviceInfo::compute_units)
      .def_ro("memory_bytes", &DeviceInfo::memory_bytes)
      .def("__repr__", [](const DeviceInfo& info) {
        return "<DeviceInfo " + std::to_string(info.index) + ": " + info.type + ", " + info.name + ">";
      });

  nb::class_<SharedDevice>(module, "Device",
                           "A chosen device for several calls of detect_edges() and match(), which build its kernels\n"
                           "once. Threads may share one; they wait for one another.")
      .def(
          "__init__",
          [](SharedDevice* self, const std::string& choice) {
            const nb::gil_scoped_release released;
            new (self) SharedDevice{Device(choice), {}};
          },
          "choice"_a = "auto",
          "choice: auto (first GPU, else first CPU), cpu, gpu, reference, a number of ``devices()``, or a part of a\n"
          "name. Raises DeviceError with the list of devices when nothing matches.")
      .def_prop_ro("info", [](const SharedDevice& self) { return self.device.info(); });

  module.def("devices", &list_devices,
             "All OpenCL devices in a fixed order; an empty list where there is no driver or no OpenCL loader.");
}

}  // namespace quadedge::python
