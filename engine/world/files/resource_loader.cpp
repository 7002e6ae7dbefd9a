#include "engine/world/files/resource_loader.hpp"

#include <algorithm>
#include <system_error>

namespace psygen::world {

bool is_below(const std::filesystem::path& folder, const std::filesystem::path& file) {
  std::error_code failed;
  const auto real_file = std::filesystem::canonical(file, failed);
  if (failed) return true;
  const auto real_folder = std::filesystem::canonical(folder, failed);
  if (failed) return true;
  return std::mismatch(real_folder.begin(), real_folder.end(), real_file.begin(), real_file.end())
             .first == real_folder.end();
}

core::Result<std::filesystem::path> Beside::path_of(std::string_view name) const {
  const std::filesystem::path folder = std::filesystem::path(world_file).parent_path();
  const std::filesystem::path file = folder / name;
  if (is_below(folder.empty() ? "." : folder, file)) return file;
  return core::fail(core::ErrorCode::kInvalidArgument,
                    file.string() + " leads out of the folder of the world file");
}

core::Result<std::shared_ptr<const GreyPicture>> Beside::read_grey(std::string_view name) const {
  if (files == nullptr)
    return core::fail(core::ErrorCode::kInvalidArgument,
                      "this program cannot read glTF models and images (engine/handmade)");
  const auto file = path_of(name);
  if (!file) return tl::unexpected(file.error());
  return files->read_grey(*file);
}

}  // namespace psygen::world
