// What a world file names beside itself and world cannot read: models in glTF files. Implemented by
// engine/handmade, handed to parse_world() by whoever reads world files. One virtual seam; any
// thread.
#pragma once

#include <filesystem>
#include <memory>

#include "engine/core/error.hpp"
#include "engine/models/model_type.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

class FilesBeside {
 public:
  virtual ~FilesBeside() = default;
  // The model type of a [[model]], whose file is `file`. Equal files and settings give types of
  // equal identity(). Fails with a sentence that names the file, and with the codes of
  // gltf::read_file().
  virtual core::Result<std::unique_ptr<models::ModelType>> read_model(
      const std::filesystem::path& file, const HandmadeModel& model) const = 0;
};

}  // namespace psygen::world
