// A value that a save can store: nothing, an integer, a real number, a text or bytes. These are the
// types of SQLite, without its header. Plain values; any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::save {

// The bytes of a blob, and a value of any type; std::monostate is NULL.
using Bytes = std::vector<std::byte>;
using Value = std::variant<std::monostate, std::int64_t, double, std::string, Bytes>;

// The maximum size of the text or bytes of one value.
inline constexpr std::size_t kMaxValueBytes = std::size_t{256} << 20;

// The rows of a query, each with one value per column.
struct Rows {
  std::vector<std::string> columns;
  std::vector<std::vector<Value>> rows;
};

// Fails with kInvalidArgument for NaN, which SQLite cannot store, and with kOverBudget for texts
// and bytes above kMaxValueBytes. `what` names the value in the message. O(1).
core::Result<void> check_value(const Value& value, const std::string& what);

}  // namespace psygen::save
