/// \file module.cpp  The module quadedge._quadedge: the public C++ library (include/quadedge) for Python.
///
/// Arrays returned by properties are read-only views of the object's memory and keep it alive.

#include <filesystem>

#include "bindings.hpp"
#include "quadedge/error.hpp"

namespace quadedge::python {
namespace {

void raise(const char* name, const std::string& message) {
  const nb::object type = nb::module_::import_("quadedge.errors").attr(name);
  PyErr_SetString(type.ptr(), message.c_str());
}

/// Translates the library's errors to the exceptions of quadedge.errors, with the same messages.
void translate_errors() {
  nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
    try {
      std::rethrow_exception(thrown);
    } catch (const UsageError& error) {
      raise("UsageError", error.what());
    } catch (const DataError& error) {
      raise("DataError", error.what());
    } catch (const DeviceError& error) {
      raise("DeviceError", error.what());
    } catch (const Error& error) {
      raise("Error", error.what());
    } catch (const std::filesystem::filesystem_error& error) {
      raise("DataError",
            error.path1().string() + ": " + error.code().message() + "; expected a readable file or folder");
    }
  });
}

}  // namespace
}  // namespace quadedge::python

NB_MODULE(_quadedge, module) {
  using namespace quadedge::python;
  module.doc() = "The compiled part of quadedge. Use the names in the package quadedge instead.";
  translate_errors();
  wait_for_work_at_exit();
  bind_devices(module);
  bind_configuration(module);
  bind_cameras(module);
  bind_trajectories(module);
  bind_datasets(module);
  bind_calibration(module);
  bind_synthetic(module);
  bind_edges(module);
  bind_taps(module);
  bind_odometry(module);
  bind_maps(module);
  bind_evaluation(module);
}
