// The fields of summary.json by their names ("frame_ms.p99"), one after the other: for budgets and
// comparisons, which name fields in files of people. Lists of the summary (world.blocks, sentences)
// have no names here. Pure.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "engine/telemetry/summary.hpp"

namespace psygen::telemetry {

// A field: a number, a text (hashes, names, "true"), or nothing with the reason.
struct SummaryField {
  std::string name;
  std::variant<std::monostate, double, std::string> value;
  std::string reason;  // where there is no value
};

// All of a summary, in the order of summary.json. Those of a Summary{} have the names that every
// run has; a run has system_ms.NAME.p50 and .p99 besides.
std::vector<SummaryField> summary_fields(const Summary& summary);

}  // namespace psygen::telemetry
