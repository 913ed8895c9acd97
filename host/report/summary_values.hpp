#pragma once
/// \file summary_values.hpp  Parts of summary.json that other JSON results share.

#include "report/batch_summary.hpp"
#include "report/json_values.hpp"

namespace quadedge::report {

Json to_json(const SummaryAccuracy& accuracy);

}  // namespace quadedge::report
