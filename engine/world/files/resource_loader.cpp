#include "engine/world/files/resource_loader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <system_error>

#include "engine/models/ground/ground_edits.hpp"

namespace psygen::world {
namespace {

std::uint64_t bytes_of(const GreyPicture& picture) {
  return std::span(picture.pixels).size_bytes();
}
std::uint64_t bytes_of(const HeightPicture& picture) {
  return std::span(picture.values).size_bytes() + std::span(picture.wholes).size_bytes();
}

tl::unexpected<core::Error> too_many_pixels() {
  return core::fail(
      core::ErrorCode::kOverBudget,
      fmt::format("all masks and stamps together need more than the allowed {} MiB (2 or 4 bytes "
                  "for each pixel of a picture, and 4 for each pixel of a stamp)",
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

core::Result<std::filesystem::path> Beside::readable(std::string_view name) const {
  if (files == nullptr)
    return core::fail(core::ErrorCode::kInvalidArgument,
                      "this program cannot read glTF models and images (engine/handmade)");
  auto file = path_of(name);
  if (file && sum != nullptr && sum->bytes > kMaxPictureBytes) return too_many_pixels();
  return file;
}

template <class Picture>
core::Result<Picture> Beside::counted(core::Result<Picture> picture,
                                      std::uint64_t kept_bytes) const {
  if (!picture || sum == nullptr) return picture;
  const std::uint64_t pixels = std::uint64_t{(*picture)->width} * (*picture)->height;
  sum->bytes += kept_bytes * pixels;
  if (std::ranges::find(sum->pictures, std::shared_ptr<const void>(*picture)) ==
      sum->pictures.end()) {
    sum->bytes += bytes_of(**picture);
    sum->pictures.push_back(*picture);
  }
  if (sum->bytes > kMaxPictureBytes) return too_many_pixels();
  return picture;
}

core::Result<std::shared_ptr<const GreyPicture>> Beside::read_grey(std::string_view name) const {
  return readable(name).and_then(
      [this](const auto& file) { return counted(files->read_grey(file), 0); });
}

core::Result<std::shared_ptr<const HeightPicture>> Beside::read_heights(
    std::string_view name) const {
  return readable(name).and_then([this](const auto& file) {
    return counted(files->read_heights(file), sizeof(models::Heightmap::heights_m[0]));
  });
}

core::Result<std::shared_ptr<const HeightPicture>> ResourceLoader::read_heights(
    const std::filesystem::path& file) const {
  return read_grey(file).map([](const std::shared_ptr<const GreyPicture>& picture) {
    return std::make_shared<const HeightPicture>(heights_of(*picture));
  });
}

}  // namespace psygen::world
