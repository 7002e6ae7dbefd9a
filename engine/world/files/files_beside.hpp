// What a world file names beside itself and world cannot read: models in glTF files, and pictures.
// Implemented by engine/handmade, handed to parse_world() by whoever reads world files. One virtual
// seam; any thread.
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

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
  // A picture of at most 4096 × 4096 pixels as grey values. Fails likewise.
  virtual core::Result<std::shared_ptr<const GreyPicture>> read_grey(
      const std::filesystem::path& file) const = 0;
};

// The files beside one world file.
struct Beside {
  std::string_view world_file;  // names are relative to its folder
  const FilesBeside* files;     // null: this program reads none

  // The file of a name. Fails with kInvalidArgument where links lead out of the folder.
  core::Result<std::filesystem::path> path_of(std::string_view name) const;
  // The picture in it. Fails also without a reader of files, with kInvalidArgument.
  core::Result<std::shared_ptr<const GreyPicture>> read_grey(std::string_view name) const;
};

// Whether a file, with all links followed, is in the folder or below. Files that do not exist are:
// reading tells.
bool is_below(const std::filesystem::path& folder, const std::filesystem::path& file);

}  // namespace psygen::world
