#include "engine/save/bound_value.hpp"

#include <type_traits>

namespace psygen::save {

void bind_value(Statement& statement, int index, const Value& value) {
  const auto bind_one = [&](const auto& content) {
    using Content = std::decay_t<decltype(content)>;
    if constexpr (std::is_same_v<Content, std::monostate>) {
      statement.bind_null(index);
    } else if constexpr (std::is_same_v<Content, std::string>) {
      statement.bind(index, std::string_view(content));
    } else if constexpr (std::is_same_v<Content, Bytes>) {
      statement.bind(index, std::span<const std::byte>(content));
    } else {
      statement.bind(index, content);
    }
  };
  std::visit(bind_one, value);
}

Value value_of(const Statement& statement, int column) {
  switch (statement.type(column)) {
    case SQLITE_INTEGER:
      return statement.integer(column);
    case SQLITE_FLOAT:
      return statement.real(column);
    case SQLITE_TEXT:
      return std::string(statement.text(column));
    case SQLITE_BLOB: {
      const auto content = statement.bytes(column);
      return Bytes(content.begin(), content.end());
    }
    default:
      return std::monostate{};
  }
}

}  // namespace psygen::save
