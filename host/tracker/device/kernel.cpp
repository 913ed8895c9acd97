/// \file kernel.cpp  Compares the arguments that the driver reports with the C++ signature, in canonical spelling.
#include "device/kernel.hpp"

#include <algorithm>
#include <cctype>
#include <set>

namespace quadedge::opencl {
namespace {

std::string words(const ArgumentType& type) {
  return std::string(type.global ? "global " : "") + (type.constant ? "const " : "") + type.type;
}

/// Splits a type into identifiers and asterisks.
std::vector<std::string> tokens(const std::string& spelling) {
  std::vector<std::string> found;
  bool in_word = false;
  for (const char c : spelling) {
    const bool letter = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
    if (letter && in_word) {
      found.back() += c;
    } else if (letter || c == '*') {
      found.emplace_back(1, c);
    }
    in_word = letter;
  }
  return found;
}

bool names_const(const std::string& spelling) {
  const auto all = tokens(spelling);
  return std::find(all.begin(), all.end(), "const") != all.end();
}

std::string without_padding(std::string text) {
  while (!text.empty() && (text.back() == '\0' || text.back() == ' ')) text.pop_back();
  return text;
}

ReportedArgument reported_argument(const cl::Kernel& kernel, cl_uint index) {
  ReportedArgument argument;
  argument.name = without_padding(kernel.getArgInfo<CL_KERNEL_ARG_NAME>(index));
  argument.type = without_padding(kernel.getArgInfo<CL_KERNEL_ARG_TYPE_NAME>(index));
  argument.global = kernel.getArgInfo<CL_KERNEL_ARG_ADDRESS_QUALIFIER>(index) == CL_KERNEL_ARG_ADDRESS_GLOBAL;
  argument.constant = (kernel.getArgInfo<CL_KERNEL_ARG_TYPE_QUALIFIER>(index) & CL_KERNEL_ARG_TYPE_CONST) != 0;
  return argument;
}

}  // namespace

std::string canonical_type(const std::string& spelling) {
  static const std::set<std::string> ignored = {"const",  "volatile", "restrict",  "__restrict", "__const",
                                                "global", "__global", "private",   "__private",  "struct",
                                                "signed", "__signed", "__signed__"};
  std::string base, stars;
  bool is_unsigned = false, is_integer = false;
  for (const auto& token : tokens(spelling)) {
    if (token == "*") {
      stars += token;
    } else if (token == "unsigned") {
      is_unsigned = true;
    } else if (token == "signed" || (token == "int" && !base.empty())) {
      is_integer = true;  // "signed", "short int"
    } else if (ignored.count(token) == 0) {
      base = token;
    }
  }
  if (base.empty() && (is_unsigned || is_integer)) base = "int";
  return (is_unsigned ? "u" : "") + base + stars;
}

std::string argument_difference(const ReportedArgument& reported, const ArgumentType& expected) {
  if (reported.type.empty()) return {};
  ArgumentType found{canonical_type(reported.type), reported.global, false};
  const bool is_pointer = found.type.find('*') != std::string::npos;
  found.constant = is_pointer && (reported.constant || names_const(reported.type));
  const bool same_pointer = !is_pointer || (found.global == expected.global && found.constant == expected.constant);
  if (found.type == canonical_type(expected.type) && same_pointer) return {};
  return "(" + reported.name + "): the kernel declares " + words(found) + ", the host passes " + words(expected);
}

std::vector<std::string> kernel_faults(const cl::Kernel& kernel, const std::string& name,
                                       const std::vector<ArgumentType>& expected) {
  std::vector<std::string> faults;
  try {
    const cl_uint count = kernel.getInfo<CL_KERNEL_NUM_ARGS>();
    if (count != expected.size()) {
      faults.push_back("kernel " + name + " takes " + std::to_string(count) + " arguments, the host passes " +
                       std::to_string(expected.size()));
      return faults;
    }
    for (cl_uint i = 0; i < count; ++i) {
      const std::string difference = argument_difference(reported_argument(kernel, i), expected[i]);
      if (!difference.empty())
        faults.push_back("kernel " + name + ", argument " + std::to_string(i) + " " + difference);
    }
  } catch (const cl::Error& error) {
    // A program made from a binary may lack the names of its arguments.
    if (error.err() != CL_KERNEL_ARG_INFO_NOT_AVAILABLE)
      faults.push_back("the signature of kernel " + name + " cannot be read: " + status_name(error.err()));
  }
  return faults;
}

GroupLimit group_limit(const cl::Kernel& kernel, const std::string& name, const Context& context) {
  try {
    const std::size_t items = kernel.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(context.device());
    const auto required = kernel.getWorkGroupInfo<CL_KERNEL_COMPILE_WORK_GROUP_SIZE>(context.device());
    const std::size_t most = context.limits().group_items;
    return {items == 0 ? most : std::min(items, most), required[0] > 0};
  } catch (const cl::Error& error) {
    throw_device_error("reading the group size of kernel " + name, error.err(), context.name());
  }
}

void check_local_memory(const cl::Kernel& kernel, const std::string& name, const Context& context) {
  cl_ulong bytes = 0;
  try {
    bytes = kernel.getWorkGroupInfo<CL_KERNEL_LOCAL_MEM_SIZE>(context.device());
  } catch (const cl::Error& error) {
    throw_device_error("reading the local memory of kernel " + name, error.err(), context.name());
  }
  constexpr std::size_t kLittle = 2048;  // available on every device; used by kernels with one group per image
  if (bytes <= std::max(context.limits().local_bytes, kLittle)) return;
  throw DeviceError("kernel " + name + " takes " + std::to_string(bytes) + " bytes of local memory, " + context.name() +
                    " has " + std::to_string(context.limits().local_bytes));
}

}  // namespace quadedge::opencl
