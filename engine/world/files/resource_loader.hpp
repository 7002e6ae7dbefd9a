// Reads the files that a world file names but world itself cannot read: glTF models and images.
// engine/handmade implements it; callers of parse_world() pass it. One virtual seam; any thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/models/model_type.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// A [[model]] and the path of its file.
struct ModelFile {
  std::filesystem::path path;
  const HandmadeModel* model;
};

// The model types of [[model]] tables, in their order. After a failure, which is the last element,
// no more are read.
using ModelTypes = std::vector<core::Result<std::unique_ptr<models::ModelType>>>;

class ResourceLoader {
 public:
  virtual ~ResourceLoader() = default;
  // The model types of [[model]] tables. Equal files and settings give types of equal identity().
  // Error messages name the file; error codes are those of gltf::read_file().
  virtual ModelTypes read_models(std::span<const ModelFile> files) const = 0;
  // An image of at most 4096 × 4096 pixels as grey values. Same errors.
  virtual core::Result<std::shared_ptr<const GreyPicture>> read_grey(
      const std::filesystem::path& file) const = 0;
  // The same image as numbers; by default those of read_grey().
  virtual core::Result<std::shared_ptr<const HeightPicture>> read_heights(
      const std::filesystem::path& file) const;
};

// The most memory of all masks and stamps of one world file together, in bytes: 2 for each pixel of
// each picture, or 4 if a stamp's numbers are not whole, and 4 more for each pixel of each stamp,
// which keeps heights.
inline constexpr std::uint64_t kMaxPictureBytes = std::uint64_t{512} << 20;

// The pictures of one world file so far.
struct PictureSum {
  std::uint64_t bytes = 0;
  std::vector<std::shared_ptr<const void>> pictures;  // each once
};

// The files that one world file names.
struct Beside {
  std::string_view world_file;  // names are relative to its folder
  const ResourceLoader* files;  // null: this program cannot read any
  PictureSum* sum = nullptr;    // null: pictures have no limit together

  // The path of a name. Fails with kInvalidArgument if links lead out of the folder.
  core::Result<std::filesystem::path> path_of(std::string_view name) const;
  // The image with this name, as grey values for a mask or as numbers for a stamp. Also fail with
  // kInvalidArgument if `files` is null, and with kOverBudget above kMaxPictureBytes.
  core::Result<std::shared_ptr<const GreyPicture>> read_grey(std::string_view name) const;
  core::Result<std::shared_ptr<const HeightPicture>> read_heights(std::string_view name) const;

 private:
  core::Result<std::filesystem::path> readable(std::string_view name) const;
  // Adds a picture, of which the world keeps `kept_bytes` more for each pixel, to the sum.
  template <class Picture>
  core::Result<Picture> counted(core::Result<Picture> picture, std::uint64_t kept_bytes) const;
};

// True if a file, after following all links, is in the folder or below. Also true for files that do
// not exist; reading them fails later.
bool is_below(const std::filesystem::path& folder, const std::filesystem::path& file);

}  // namespace psygen::world
