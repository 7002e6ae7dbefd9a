#include "engine/save/value.hpp"

#include <fmt/format.h>

#include <cmath>

namespace psygen::save {

core::Result<void> check_value(const Value& value, const std::string& what) {
  if (const auto* real = std::get_if<double>(&value); real != nullptr && std::isnan(*real))
    return core::fail(core::ErrorCode::kInvalidArgument,
                      fmt::format("{}: NaN cannot be stored", what));
  std::size_t bytes = 0;
  if (const auto* text = std::get_if<std::string>(&value)) bytes = text->size();
  if (const auto* raw = std::get_if<Bytes>(&value)) bytes = raw->size();
  if (bytes > kMaxValueBytes)
    return core::fail(core::ErrorCode::kOverBudget,
                      fmt::format("{}: a value has {} bytes; at most {} are allowed", what, bytes,
                                  kMaxValueBytes));
  return {};
}

}  // namespace psygen::save
