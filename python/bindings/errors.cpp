/// \file errors.cpp  Translates the library's errors to the exceptions of quadedge.errors, with the same messages.

#include <filesystem>

#include "bindings.hpp"
#include "quadedge/error.hpp"

namespace quadedge::python {
namespace {

void raise(const char* name, const std::string& message) {
  const nb::object type = nb::module_::import_("quadedge.errors").attr(name);
  PyErr_SetString(type.ptr(), message.c_str());
}

}  // namespace

void bind_errors(nb::module_&) {
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

}  // namespace quadedge::python
