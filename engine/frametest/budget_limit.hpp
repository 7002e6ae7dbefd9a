// Reads the limit of a budget in a frame test: a number, a text, or a factor of the base, alone or
// in a table with further options. Pure.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "engine/frametest/frame_test.hpp"
#include "engine/world/files/table_reader.hpp"

namespace psygen::frametest {

// Smallest and largest factor of a base.
inline constexpr double kMinFactor = 0.01, kMaxFactor = 100;

// The factor in "1.05 × base", also with x or * and without blanks; nothing for other texts.
std::optional<double> factor_of_base(std::string_view text);

// True if a table is a limit with options, { limit = 25, witness = "none" }, and not a part of a
// field's name.
bool is_limit(const world::Node& node);

// Reads the limit into `budget`, whose relation and line are set. Returns false after a problem.
// `where` names the field in messages.
bool read_limit(const world::Node& node, const std::string& where, world::Problems& problems,
                Budget& budget);

}  // namespace psygen::frametest
