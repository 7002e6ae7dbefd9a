// Exports of the world that is edited: one of its models, or a block, as glTF or OBJ, as `psygen
// export` writes them. Takes as long as their meshes; any thread.
#pragma once

#include <filesystem>
#include <string>

#include "editor/document/parsed_world.hpp"
#include "engine/core/coordinates.hpp"
#include "engine/exchange/document.hpp"

namespace psygen::editor {

// Write a file (.glb or .obj) and return what is in it: "1 object, 3,201 vertices, 5,120
// triangles". Levels beyond the coarsest are the coarsest. Fail with kInvalidArgument for other
// names, for blocks outside the world and where a block has no model of this index; like
// amplify::block_document() and exchange::write_document().
core::Result<std::string> export_block(const ParsedWorld& parsed, core::BlockCoord block, int level,
                                       const std::filesystem::path& file);
core::Result<std::string> export_model(const ParsedWorld& parsed, core::BlockCoord block,
                                       std::uint32_t index, int level,
                                       const std::filesystem::path& file);

}  // namespace psygen::editor
