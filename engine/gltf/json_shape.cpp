#include "engine/gltf/json_shape.hpp"

#include <fmt/format.h>

namespace psygen::gltf {
namespace {

// glTF itself needs seven; the rest is for program data in "extras".
constexpr std::uint32_t kMaxDepth = 64;

// The position after a string that begins at `at`.
std::size_t behind_string(std::string_view json, std::size_t at) {
  for (++at; at < json.size() && json[at] != '"'; ++at)
    at += json[at] == '\\' ? 1 : 0;
  return at + 1;
}

}  // namespace

core::Result<void> check_shape(std::string_view json, std::uint32_t max_values) {
  std::uint32_t depth = 0, values = 0;
  for (std::size_t at = 0; at < json.size();) {
    const char c = json[at];
    if (c == '"') {
      at = behind_string(json, at);
      continue;
    }
    ++at;
    if ((c == ']' || c == '}') && depth > 0) --depth;
    if (c == ',') ++values;
    if (c != '[' && c != '{') continue;
    ++values;
    if (++depth > kMaxDepth) {
      return core::fail(core::ErrorCode::kOverBudget,
                        fmt::format("its JSON is nested more than {} levels deep at character {}",
                                    kMaxDepth, at));
    }
    if (values > max_values) break;
  }
  if (values <= max_values) return {};
  return core::fail(core::ErrorCode::kOverBudget,
                    fmt::format("its JSON has more than {} values", max_values));
}

}  // namespace psygen::gltf
