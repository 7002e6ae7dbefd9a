#include "engine/world/files/resource_loader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

namespace psygen::world {
namespace {

tl::unexpected<core::Error> too_many_pixels() {
  return core::fail(
      core::ErrorCode::kOverBudget,
      fmt::format("all masks and stamps together need more than the allowed {} MiB (2 bytes for "
                  "each pixel of a picture, and 4 for each pixel of a stamp)",
                  kMaxPictureBytes >> 20));
}

}  // namespace

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

core::Result<std::shared_ptr<const GreyPicture>> Beside::read_grey(std::string_view name,
                                                                   std::uint64_t kept_bytes) const {
  if (files == nullptr)
    return core::fail(core::ErrorCode::kInvalidArgument,
                      "this program cannot read glTF models and images (engine/handmade)");
  const auto file = path_of(name);
  if (!file) return tl::unexpected(file.error());
  if (sum != nullptr && sum->bytes > kMaxPictureBytes) return too_many_pixels();
  auto picture = files->read_grey(*file);
  if (!picture || sum == nullptr) return picture;
  const std::uint64_t pixels = (*picture)->pixels.size();
  sum->bytes += kept_bytes * pixels;
  if (std::ranges::find(sum->pictures, *picture) == sum->pictures.end()) {
    sum->bytes += sizeof(GreyPicture::pixels[0]) * pixels;
    sum->pictures.push_back(*picture);
  }
  if (sum->bytes > kMaxPictureBytes) return too_many_pixels();
  return picture;
}

}  // namespace psygen::world
