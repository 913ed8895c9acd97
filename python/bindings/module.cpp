/// \file module.cpp  The module quadedge._quadedge: the public C++ library (include/quadedge) for Python.
///
/// Arrays returned by properties are read-only views of the object's memory and keep it alive.

#include "bindings.hpp"

NB_MODULE(_quadedge, module) {
  using namespace quadedge::python;
  module.doc() = "The compiled part of quadedge. Use the names in the package quadedge instead.";
  bind_errors(module);
  bind_devices(module);
  bind_configuration(module);
  bind_cameras(module);
  bind_trajectories(module);
  bind_datasets(module);
  bind_synthetic(module);
  bind_edges(module);
  bind_odometry(module);
  bind_maps(module);
  bind_evaluation(module);
}
