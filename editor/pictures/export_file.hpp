// Exports a model or a block of the document as glTF or OBJ, like `psygen export`. Takes as long as
// the synthesis of the meshes; any thread.
#pragma once

#include <filesystem>
#include <string>

#include "editor/document/parsed_world.hpp"
#include "engine/core/coordinates.hpp"
#include "engine/exchange/document.hpp"

namespace psygen::editor {

// Write a file (.glb or .obj) and return a summary: "1 object, 3,201 vertices, 5,120 triangles".
// Levels beyond the coarsest become the coarsest. Fail with kInvalidArgument for other extensions,
// for blocks outside the world, and if the block has no model of this index; also like
// amplify::block_document() and exchange::write_scene().
core::Result<std::string> export_block(const ParsedWorld& parsed, core::BlockCoord block, int level,
                                       const std::filesystem::path& file);
core::Result<std::string> export_model(const ParsedWorld& parsed, core::BlockCoord block,
                                       std::uint32_t index, int level,
                                       const std::filesystem::path& file);

}  // namespace psygen::editor
