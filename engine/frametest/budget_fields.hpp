// The fields of summary.json that budgets may name. Any thread.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/frametest/frame_test.hpp"
#include "engine/telemetry/marks.hpp"

namespace psygen::frametest {

// Splits "sections.NAME.FIELD", where NAME may have dots. Both are empty for other fields, and for
// sections that do not exist.
struct SectionField {
  std::string_view section, field;
};
SectionField section_field(std::string_view field,
                           std::span<const telemetry::SectionRange> sections);

// The names of the fields of every summary, and of those that are texts.
class KnownFields {
 public:
  KnownFields();
  // Returns the error of a budget; empty if it is valid. The names of systems, figures and marks
  // are unknown until the flight exists.
  std::string problem(const Budget& budget,
                      std::span<const telemetry::SectionRange> sections) const;

 private:
  std::string problem_in_section(const Budget& budget,
                                 std::span<const telemetry::SectionRange> sections) const;

  std::vector<std::string> names_, texts_;
  std::vector<std::string> section_names_;  // below sections.NAME
};

}  // namespace psygen::frametest
