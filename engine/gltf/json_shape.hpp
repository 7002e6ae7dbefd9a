// Rejects JSON that is far larger in memory than as text, before it is parsed: endlessly nested
// lists, and millions of small values. Not a parser: it accepts text that is not JSON. Pure.
#pragma once

#include <cstdint>
#include <string_view>

#include "engine/core/error.hpp"

namespace psygen::gltf {

// Fails with kOverBudget; the message does not name the file. O(characters).
core::Result<void> check_shape(std::string_view json, std::uint32_t max_values);

}  // namespace psygen::gltf
