#include "engine/app/ground_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "engine/image/image_io.hpp"
#include "engine/world/world.hpp"

namespace psygen::app {

namespace {

// Whether a file, with all links followed, is in the folder or below. Files that do not exist are:
// reading tells.
bool is_below(const std::filesystem::path& folder, const std::filesystem::path& file) {
  std::error_code failed;
  const auto real_file = std::filesystem::canonical(file, failed);
  if (failed) return true;
  const auto real_folder = std::filesystem::canonical(folder, failed);
  if (failed) return true;
  return std::mismatch(real_folder.begin(), real_folder.end(), real_file.begin(), real_file.end())
             .first == real_folder.end();
}

core::Result<render::GroundPicture> read_picture(const std::filesystem::path& folder,
                                                 const std::string& name) {
  const std::filesystem::path file = folder / name;
  if (!is_below(folder, file))
    return core::fail(core::ErrorCode::kInvalidArgument,
                      file.string() + " leads out of the folder of the world's file");
  constexpr std::uint64_t kMostBytes = std::uint64_t{64} << 20;
  const image::ImageLimits limits{render::kLargestGroundPicture, render::kLargestGroundPicture,
                                  kMostBytes, kMostBytes};
  auto image = image::read_image(file, limits);
  if (!image) return tl::unexpected(image.error());
  return render::ground_picture(image->width, image->height, image->rgba)
      .map_error([&](const core::Error& error) {
        return core::Error{error.code, file.string() + ": " + error.message};
      });
}

}  // namespace

core::Result<GroundPictures> read_ground_pictures(const world::World& world,
                                                  const std::filesystem::path& world_file) {
  static_assert(render::kGroundPictures == world::kPaletteImages.size());
  const std::filesystem::path folder =
      world_file.has_parent_path() ? world_file.parent_path() : std::filesystem::path(".");
  GroundPictures out;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::string& name = world.palette.images[i];
    if (name.empty()) continue;
    auto picture = read_picture(folder, name);
    if (!picture) {
      return core::fail(picture.error().code,
                        fmt::format("{}: palette.{}: {}", world_file.string(),
                                    world::kPaletteImages[i], picture.error().message));
    }
    out[i] = std::move(*picture);
  }
  return out;
}

}  // namespace psygen::app
