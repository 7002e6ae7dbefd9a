// Writes values as TOML, for edits of texts and for writers. Numbers are the shortest that read
// back equal. It reads nothing. Pure, any thread.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/coordinates.hpp"

namespace psygen::world {

// A number. Whole reals have no decimal point, which readers of world files accept: 3, 0.25, 1e+20.
std::string toml_number(double value);
std::string toml_number(std::int64_t value);
// A seed: in quotes from 2^63 on, because TOML has no larger integers.
std::string toml_seed(std::uint64_t seed);
// "[a, b, c]".
std::string toml_vector(std::span<const double> values);
std::string toml_vector(const glm::vec3& value);
// One number if low == high, else "[low, high]". Integers are rounded.
std::string toml_range(double low, double high, bool integers = false);
// A text in quotes. Control characters are escaped.
std::string toml_string(std::string_view text);

}  // namespace psygen::world
