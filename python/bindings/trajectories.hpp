#pragma once
/// \file trajectories.hpp  Trajectories are a class of their own for Python, not lists.

#include <nanobind/stl/bind_vector.h>

#include "bindings.hpp"
#include "quadedge/trajectory.hpp"

NB_MAKE_OPAQUE(quadedge::Trajectory)
