// Bindings as TOML: one [[action]] each, with its [[action.binding]]s (docs/input.md). Actions that
// a file does not mention keep their bindings; an entry without bindings removes them. An invalid
// file changes nothing. One thread per file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "engine/input/actions.hpp"

namespace psygen::input {

inline constexpr int kBindingsFormat = 1;

// The text of a file with the current bindings of all actions.
std::string bindings_text(const Actions& actions);
// Sets the bindings of actions from a text. Fails with kParse, naming file, line and field: for
// text that is not TOML, another format, unknown keys, unknown or duplicate actions, unknown
// controls, and scales and dead zones out of range. `file_name` is for messages.
core::Result<void> apply_bindings(std::string_view text, std::string_view file_name,
                                  Actions& actions);

// The same for a file, which is replaced as a whole. Both also fail with kIo, and load_bindings()
// with kOverBudget for files over 1 MiB.
core::Result<void> save_bindings(const Actions& actions, const std::filesystem::path& file);
core::Result<void> load_bindings(const std::filesystem::path& file, Actions& actions);

}  // namespace psygen::input
