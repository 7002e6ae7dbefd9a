#include "engine/telemetry/marks.hpp"

#include <utility>

#include "engine/telemetry/own_figures.hpp"

namespace psygen::telemetry {

void Marks::set(std::string_view name) {
  if (!is_own_name(name) || name == kEndOfRun || set_ >= kMaxMarks) {
    ++ignored_;
    return;
  }
  pending_.emplace_back(name);
  ++set_;
}

std::vector<std::string> Marks::take() {
  return std::exchange(pending_, {});
}

}  // namespace psygen::telemetry
