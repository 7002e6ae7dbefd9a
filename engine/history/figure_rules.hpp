// What a figure of a history measures: its scale, the smallest change that counts, and the second
// witness of a change. Derived from the names of summary.json and their units. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace psygen::history {

enum class FigureKind : std::uint8_t {
  kInstructions,
  kProcessorTime,  // witness: its ratio to the processor time of the reference load
  kWallTime,       // witness: its ratio to the wall time of the reference load on all cores
  kFixedCost,      // frame times of the virtual clock
  kBytes,
  kCount,  // counts and percentages
};

// Units of times that are fixed costs of the virtual clock begin with this: "virtual ms".
inline constexpr std::string_view kVirtual = "virtual ";

struct FigureRule {
  FigureKind kind = FigureKind::kCount;
  // The scale on which changes are judged: natural logarithms, or plain differences.
  bool logarithms = false;
  double floor = 1;   // smallest change that counts
  double wanted = 1;  // "same" is said if a change of this size would have been seen
  bool has_reference = false;
  bool more_is_worse = true;
  // It takes part in the verdict of a check unless other figures are named.
  bool gates = false;
};

// The rule of a figure by its name and unit; plain counts if nothing is known of them.
FigureRule rule_of(std::string_view figure, std::string_view unit);

// The unit that a field of summary.json has by its name: "ms" of frame_ms.p50. Empty for counts.
std::string unit_of(std::string_view field);

// A change on the scale of a rule: "+5.0 %" of a logarithm, "+2" of a difference.
std::string change_text(const FigureRule& rule, double change);

}  // namespace psygen::history
