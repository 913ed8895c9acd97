#include "opencl/kernel.hpp"

#include <algorithm>

namespace quadedge::opencl {
namespace {

std::string words(const ArgumentType& type) {
  return std::string(type.global ? "global " : "") + (type.constant ? "const " : "") + type.type;
}

std::string trimmed(std::string text) {
  while (!text.empty() && (text.back() == '\0' || text.back() == ' ')) text.pop_back();
  return text;
}

}  // namespace

void check_signature(const cl::Kernel& kernel, const std::vector<ArgumentType>& expected, const Context& context) {
  std::string name;
  try {
    name = trimmed(kernel.getInfo<CL_KERNEL_FUNCTION_NAME>());
    const cl_uint count = kernel.getInfo<CL_KERNEL_NUM_ARGS>();
    if (count != expected.size()) {
      throw DeviceError("kernel " + name + " takes " + std::to_string(count) + " arguments, the host passes " +
                        std::to_string(expected.size()));
    }
    for (cl_uint i = 0; i < count; ++i) {
      ArgumentType found;
      found.type = trimmed(kernel.getArgInfo<CL_KERNEL_ARG_TYPE_NAME>(i));
      found.global = kernel.getArgInfo<CL_KERNEL_ARG_ADDRESS_QUALIFIER>(i) == CL_KERNEL_ARG_ADDRESS_GLOBAL;
      found.constant =
          found.global && (kernel.getArgInfo<CL_KERNEL_ARG_TYPE_QUALIFIER>(i) & CL_KERNEL_ARG_TYPE_CONST) != 0;
      if (found.type != expected[i].type || found.global != expected[i].global ||
          found.constant != expected[i].constant) {
        throw DeviceError("kernel " + name + ", argument " + std::to_string(i) + " (" +
                          trimmed(kernel.getArgInfo<CL_KERNEL_ARG_NAME>(i)) + "): the kernel declares " + words(found) +
                          ", the host passes " + words(expected[i]));
      }
    }
  } catch (const cl::Error& error) {
    // A program that comes from a binary may have no names; they were compared when it was built from the same source.
    if (error.err() == CL_KERNEL_ARG_INFO_NOT_AVAILABLE) return;
    throw_device_error("reading the signature of kernel " + name, error.err(), context.name());
  }
}

void check_local_memory(const cl::Kernel& kernel, const std::string& name, const Context& context) {
  const auto bytes = kernel.getWorkGroupInfo<CL_KERNEL_LOCAL_MEM_SIZE>(context.device());
  constexpr std::size_t kLittle = 2048;  // every device has as much; kernels of one group per image take it
  if (bytes <= std::max(context.limits().local_bytes, kLittle)) return;
  throw DeviceError("kernel " + name + " takes " + std::to_string(bytes) + " bytes of local memory, " + context.name() +
                    " has " + std::to_string(context.limits().local_bytes));
}

}  // namespace quadedge::opencl
