#pragma once
/// \file trajectories.hpp  Makes Trajectory a Python class instead of a list.

#include <nanobind/stl/bind_vector.h>

#include "bindings.hpp"
#include "quadedge/trajectory.hpp"

NB_MAKE_OPAQUE(quadedge::Trajectory)
