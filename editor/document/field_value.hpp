// Values of fields in a world text, with the other changes that keep the world valid. Pure; any
// thread.
#pragma once

#include <string>
#include <string_view>

#include "editor/document/parsed_world.hpp"
#include "engine/world/files/text_path.hpp"

namespace psygen::editor {

// Returns the text with another value at `path`, like world::with_value(). A new name of a species
// or of a model from a file is also written where scatter layers and placed models use it. Another
// model of a scatter layer or of a placed model drops the parameters that the new model lacks.
// `before` is the world of `text`. Fails like world::with_value().
core::Result<std::string> with_field_value(std::string_view text, const ParsedWorld& before,
                                           const world::TextPath& path,
                                           std::string_view toml_value);

}  // namespace psygen::editor
