#include "engine/app/ground_pictures.hpp"

#include <fmt/format.h>

#include "engine/image/image_io.hpp"
#include "engine/world/files/resource_loader.hpp"
#include "engine/world/world.hpp"

namespace psygen::app {

namespace {

core::Result<render::GroundPicture> read_picture(const std::filesystem::path& folder,
                                                 const std::string& name) {
  const std::filesystem::path file = folder / name;
  if (!world::is_below(folder, file))
    return core::invalid_argument(file.string() + " leads out of the folder of the world file");
  constexpr std::uint64_t kMaxBytes = std::uint64_t{64} << 20;
  const image::ImageLimits limits{render::kLargestGroundPicture, render::kLargestGroundPicture,
                                  kMaxBytes, kMaxBytes};
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
