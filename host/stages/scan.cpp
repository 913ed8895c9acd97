#include "stages/scan.hpp"

#include "opencl/variants.hpp"

namespace quadedge::stages {
namespace {

constexpr std::size_t kGroups = 32, kSingleItems = 8;  // of many work-items, of one
constexpr int kSmall = 4096;                           // one group is enough up to here

}  // namespace

Scan::Scan(opencl::Context& context, const std::map<std::string, std::string>& variants) : context_(&context) {
  const auto& variant = opencl::choose_variant("scan", context, variants);
  local_size_ = static_cast<std::size_t>(variant.local_size);
  groups_ = variant.form == opencl::Form::groups ? kGroups : kSingleItems;
  kernel_ = {context, variant.program(context, {{"SCAN_LOCAL", std::to_string(local_size_)}}), "scan"};
}

void Scan::run(const opencl::Buffer<cl_int>& counts, int count, int capacity, opencl::Buffer<cl_int>& first,
               opencl::Buffer<cl_int>& total) {
  first.ensure(*context_, static_cast<std::size_t>(count) + 1);
  total.ensure(*context_, 2);
  const std::size_t groups = count <= kSmall ? 1 : groups_;
  const std::string user = context_->stage();
  context_->begin_stage("scan");
  kernel_({groups * local_size_, local_size_}, counts, count, capacity, first, total);
  context_->begin_stage(user);
}

}  // namespace quadedge::stages
