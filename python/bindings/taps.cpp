/// \file taps.cpp  Observation of the pipeline after every filter (include/quadedge/tap.hpp).

#include "taps.hpp"

#include <nanobind/stl/string.h>

#include "arrays.hpp"
#include "edges.hpp"
#include "quadedge/match_stereo.hpp"

namespace quadedge::python {
namespace {

template <class... Arguments>
void call(const PythonTap& tap, const char* method, const Arguments&... arguments) {
  const nb::gil_scoped_acquire held;
  nb::find(tap).attr(method)(arguments...);
}

const char* name_of(Side side) { return side == Side::left ? "left" : "right"; }

template <class Filter, int size>
void bind_filter(nb::module_& module, const char* name, const char* const (&names)[size], const char* help) {
  static_assert(size == order_of(Filter::best) + 1);
  nb::enum_<Filter> filter(module, name, nb::is_arithmetic(), help);
  for (int order = 0; order < size; ++order) filter.value(names[order], static_cast<Filter>(order));
  filter.def_prop_ro(
      "title", [](Filter self) { return std::string(to_string(self)); }, "Name in tables.");
}

void bind_filters(nb::module_& module) {
  bind_filter<StereoFilter>(
      module, "StereoFilter",
      {"baseline", "epipolar_distance", "disparity", "orientation", "sift", "ncc", "nearly_best_ncc",
       "nearly_best_sift", "refinement", "similarity", "relaxation", "one_to_one", "best"},
      "Stereo cascade; the value is the row of Table 1.");
  bind_filter<TemporalFilter>(module, "TemporalFilter",
                              {"baseline", "displacement", "orientation", "ncc", "sift", "nearly_best_ncc",
                               "nearly_best_sift", "refinement", "agreement", "best"},
                              "Temporal cascade; the value is the row of Table 2.");
}

void bind_candidates(nb::module_& module) {
  using Self = CandidateLists;
  nb::class_<Self>(module, "Candidates",
                   "Candidates in compressed rows: row i consists of ``first[i]`` .. ``first[i + 1] - 1`` of the flat\n"
                   "arrays.")
      .def(
          "__len__", [](const Self& self) { return self.target.size(); }, "Number of all candidates.")
      .def_prop_ro("first", view_of<Self>(&Self::first), kView, "(rows + 1,) int32.")
      .def_prop_ro("target", view_of<Self>(&Self::target), kView, "(C,) int32: index of the other edge.")
      .def_prop_ro("x", view_of<Self>(&Self::x), kView,
                   "(C,) float32: refined position [px]; (0,) where candidates lie at their targets.")
      .def_prop_ro("y", view_of<Self>(&Self::y), kView, "(C,) float32: as ``x``.")
      .def_prop_ro("cue", view_of<Self>(&Self::cue), kView,
                   "(C,) float32: the NCC or SIFT distance that the next filter compares with its threshold; (0,) if\n"
                   "it compares positions or directions.");
}

void bind_search(nb::module_& module) {
  nb::class_<EdgePositions>(module, "EdgePositions", "Positions in one image; NaN: none. All arrays are (N,) float32.")
      .def_prop_ro("x", view_of<EdgePositions>(&EdgePositions::x), kView, "[px]")
      .def_prop_ro("y", view_of<EdgePositions>(&EdgePositions::y), kView, "[px]")
      .def_prop_ro("direction", view_of<EdgePositions>(&EdgePositions::direction), kView,
                   "Direction of the tangent [rad].");
  using Self = ObservedSearch;
  nb::class_<Self>(module, "Search", "A search for the stereo edges of an earlier frame, the base, in this frame.")
      .def_ro("number", &Self::number,
              "Number among the searches of a frame; ``FrameDiagnostics.search`` names the one that gave the motion.")
      .def_ro("base_frame", &Self::base_frame, "Number of the base; frames are counted from 0.")
      .def_ro("left", &Self::left, "EdgePositions: where the edges of the base are expected in the left image.")
      .def_ro("right", &Self::right, "EdgePositions: the same in the right image.")
      .def_ro("radius", &Self::radius, "Search radius around the expected positions [px].")
      .def_ro("step", &Self::step, "Every step-th stereo edge of the base is searched for and has a row.");
}

}  // namespace

void PythonTap::watch(const StereoRig& rig) { rig_ = rig; }
void PythonTap::edges(const EdgeSet& left, const EdgeSet& right) { call(*this, "edges", left, right); }
void PythonTap::stereo_filter(StereoFilter filter, const CandidateLists& candidates) {
  call(*this, "stereo_filter", filter, candidates);
}
void PythonTap::stereo(const StereoEdges& edges) {
  call(*this, "stereo", StereoEdgesInSpace{edges, edge_points(edges, rig_)});
}
void PythonTap::temporal_search(const ObservedSearch& search) { call(*this, "temporal_search", search); }
void PythonTap::temporal_filter(TemporalFilter filter, Side side, const CandidateLists& candidates) {
  call(*this, "temporal_filter", filter, name_of(side), candidates);
}
void PythonTap::quads(const TemporalMatches& matches) { call(*this, "quads", Quads{matches, {}}); }

void bind_taps(nb::module_& module) {
  bind_filters(module);
  bind_candidates(module);
  bind_search(module);
  nb::class_<PythonTap>(
      module, "Tap",
      "Receives copies of what each stage of an Odometry computes, see Odometry.set_tap(). Derive from it; its own\n"
      "methods do nothing. It observes one Odometry at a time and cannot change results. Where a method raises an\n"
      "exception, track() ends with it; call Odometry.restart() before the next frame.")
      .def(nb::init<>())
      .def(
          "edges", [](PythonTap&, const EdgeSet&, const EdgeSet&) {}, "left"_a, "right"_a,
          "Called after edge detection of a frame.")
      .def(
          "stereo_filter", [](PythonTap&, StereoFilter, const CandidateLists&) {}, "filter"_a, "candidates"_a,
          "Called after every stereo filter between the baseline and the best. Rows are left edges, targets right "
          "edges.")
      .def(
          "stereo", [](PythonTap&, const StereoEdgesInSpace&) {}, "edges"_a,
          "Called with the final stereo edges of a frame. Their points follow the calibration, without the disparity\n"
          "offset that Odometry.edges() adds.")
      .def(
          "temporal_search", [](PythonTap&, const ObservedSearch&) {}, "search"_a,
          "Called before every temporal search.")
      .def(
          "temporal_filter", [](PythonTap&, TemporalFilter, const std::string&, const CandidateLists&) {}, "filter"_a,
          "side"_a, "candidates"_a,
          "Called after every filter of that search between the baseline and the best; side is \"left\" or \"right\".\n"
          "Row r is stereo edge r * step of the base; targets are current stereo edges.")
      .def(
          "quads", [](PythonTap&, const Quads&) {}, "quads"_a,
          "Called with the quads of that search, whose ``inlier`` is empty.");
}

}  // namespace quadedge::python
