#pragma once
/// \file bindings.hpp  The parts of the module quadedge._quadedge. Each adds its classes and functions.

#include <nanobind/nanobind.h>

#include "released_gil.hpp"

namespace quadedge::python {

namespace nb = nanobind;
using namespace nb::literals;

/// For functions that neither take nor return Python objects.
constexpr auto kReleasesGil = nb::call_guard<ReleasedGil>();

void bind_devices(nb::module_& module);
void bind_configuration(nb::module_& module);
void bind_cameras(nb::module_& module);
void bind_trajectories(nb::module_& module);
void bind_datasets(nb::module_& module);
void bind_calibration(nb::module_& module);
void bind_synthetic(nb::module_& module);
void bind_edges(nb::module_& module);
void bind_taps(nb::module_& module);
void bind_odometry(nb::module_& module);
void bind_maps(nb::module_& module);
void bind_evaluation(nb::module_& module);

}  // namespace quadedge::python
