// Refuses JSON that is far larger in memory than as a text, before it is parsed: lists in lists
// without end, and millions of small values. Not a parser: what is no JSON passes. Pure.
#pragma once

#include <cstdint>
#include <string_view>

#include "engine/core/error.hpp"

namespace psygen::gltf {

// Fails with kOverBudget, without the file's name. O(characters).
core::Result<void> check_shape(std::string_view json, std::uint32_t max_values);

}  // namespace psygen::gltf
