// Fields of summary.json by name ("frame_ms.p99"), in sequence, for budgets and comparisons, which
// name fields in users' files. Lists of the summary (world.blocks, sentences) have no names here.
// Pure.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/telemetry/summary.hpp"

namespace psygen::telemetry {

// A field: a number, a text (hashes, names, "true"), or no value with a reason.
struct SummaryField {
  std::string name;
  std::variant<std::monostate, double, std::string> value;
  std::string reason;  // if there is no value
};

// All fields of a summary, in the order of summary.json. A Summary{} has the names that every run
// has; a real run also has system_ms.NAME.p50 and .p99.
std::vector<SummaryField> summary_fields(const Summary& summary);

// The fields in the text of a summary.json; `file` is for messages. Fails with kParse for text that
// is not JSON, and for another schema.
core::Result<std::vector<SummaryField>> summary_fields_in(std::string_view text,
                                                          const std::string& file);

}  // namespace psygen::telemetry
