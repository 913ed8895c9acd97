#pragma once
/// \file edge_selection.hpp  Stage 2c: which maxima become edges. doc/method.md section 1.

#include "opencl/argument_structs.hpp"
#include "quadedge/config.hpp"
#include "stages/edge_maxima.hpp"

namespace quadedge::stages {

/// Reduces the maxima of a stereo pair to about edges.budget per image: those where curves cross evenly spaced epipolar
/// lines. The spacing stays on the device, so the host does not wait.
class EdgeSelection {
 public:
  /// \param maxima the argument of later calls of run()
  EdgeSelection(opencl::Context& context, const EdgesConfig& config, const EdgeMaxima& maxima);

  /// Enqueues the selection in both images. Does nothing if edges.budget is 0.
  /// \param in_left, in_right see selection_arguments()
  void run(const SelectionArguments& in_left, const SelectionArguments& in_right, EdgeMaxima& left, EdgeMaxima& right);

  /// Copies the spacing to host_spacing(), which is valid after the next wait for the queue.
  void request() { spacing_.read_later(&host_spacing_, 1); }
  /// Spacing of the lines in the last frame [px]; 0: all edges were kept.
  double host_spacing() const { return static_cast<double>(host_spacing_); }

 private:
  void weigh(const SelectionArguments& arguments, const EdgeMaxima& maxima, cl_int image);
  void choose(const SelectionArguments& arguments, EdgeMaxima& maxima);

  using In = opencl::In<cl_float>;
  using InInt = opencl::In<cl_int>;
  using OutInt = opencl::Out<cl_int>;
  using Out = opencl::Out<cl_float>;

  opencl::Context& context_;
  cl_int budget_;
  std::size_t local_size_, weighing_group_;
  opencl::Buffer<cl_int> tally_;  ///< weights of the left and the right image
  opencl::Buffer<cl_float> spacing_;
  cl_float host_spacing_ = 0;
  opencl::Kernel<SelectionArguments, In, InInt, cl_int, OutInt> weigh_rows_;
  opencl::Kernel<SelectionArguments, In, opencl::In<cl_uchar>, cl_int, OutInt> weigh_pixels_;
  opencl::Kernel<cl_int, OutInt, Out> space_;
  opencl::Kernel<SelectionArguments, In, Out, OutInt> choose_rows_;
  opencl::Kernel<SelectionArguments, In, In, opencl::Out<cl_uchar>> choose_pixels_;
};

}  // namespace quadedge::stages
