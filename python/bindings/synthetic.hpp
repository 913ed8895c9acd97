#pragma once
/// \file synthetic.hpp  A rendered sequence together with its options.

#include "quadedge/synthetic.hpp"

namespace quadedge::python {

struct RenderedSequence : SyntheticSequence {
  explicit RenderedSequence(const SyntheticOptions& what) : SyntheticSequence(what), options(what) {}
  SyntheticOptions options;
};

}  // namespace quadedge::python
