// Worlds with stamps and roads for tests, with images in memory.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "engine/core/hash.hpp"
#include "engine/models/terrain/ground.hpp"
#include "engine/world/files/world_file.hpp"
#include "engine/world/placement.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world::testing {

// Reads only images, no models.
class PicturesAlone : public ResourceLoader {
 public:
  ModelTypes read_models(std::span<const ModelFile> files) const final {
    ModelTypes types;
    if (!files.empty())
      types.emplace_back(
          core::fail(core::ErrorCode::kIo, files.front().path.string() + ": no models"));
    return types;
  }
};

// Images by name: "ramp.png" has 17 × 17 different values, "white.png" 3 × 3, "dot.png" one
// pixel; others are missing. "metres.exr" has 5 × 3 numbers, 10 + column + 5 row, and -9999 in
// column 2 of row 1; "colours.exr" the same in colours.
class MadePictures final : public PicturesAlone {
 public:
  core::Result<std::shared_ptr<const GreyPicture>> read_grey(
      const std::filesystem::path& file) const override {
    const std::string name = file.filename().string();
    if (name == "ramp.png") return made(17, [](std::uint32_t i) { return i * 65'535 / 288; });
    if (name == "white.png") return made(3, [](std::uint32_t) { return 65'535; });
    if (name == "dot.png") return made(1, [](std::uint32_t) { return 9; });
    return core::fail(core::ErrorCode::kIo, file.string() + ": there is no such file");
  }
  core::Result<std::shared_ptr<const HeightPicture>> read_heights(
      const std::filesystem::path& file) const override {
    const std::string name = file.filename().string();
    const bool coloured = name == "colours.exr";
    if (name != "metres.exr" && !coloured) return ResourceLoader::read_heights(file);
    HeightPicture picture{
        .width = 5, .height = 3, .values = {}, .wholes = {}, .is_coloured = coloured};
    for (int i = 0; i < 15; ++i)
      picture.values.push_back(i == 7 ? -9999 : static_cast<float>(10 + i));
    return std::make_shared<const HeightPicture>(finished(std::move(picture)));
  }

 private:
  template <class Grey>
  static std::shared_ptr<const GreyPicture> made(std::uint32_t side, const Grey& grey) {
    auto picture = std::make_shared<GreyPicture>();
    picture->width = picture->height = side;
    for (std::uint32_t i = 0; i < side * side; ++i)
      picture->pixels.push_back(static_cast<std::uint16_t>(grey(i)));
    picture->hash = content_hash(*picture);
    return picture;
  }
};

inline core::Result<World> read_shaped_world(const std::string& tables,
                                             const std::string& text = kSmallWorld) {
  static const MadePictures pictures;
  return parse_world(text + tables, "maps/w.toml", registry(), &pictures);
}

// kSmallWorld, which is 512 m by 256 m and up to 60 m high, with these tables.
inline World shaped_world(const std::string& tables) {
  auto world = read_shaped_world(tables);
  if (!world) std::fprintf(stderr, "%s\n", world.error().message.c_str());
  PSYGEN_CHECK(world.has_value(), "the world of the test is sound");
  return std::move(*world);
}

inline constexpr double kQuantumM = 60.0 / 65535;  // step of its heights
inline constexpr double kShapedBlockM = 64;

inline double height_at(const World& world, double x, double z) {
  const core::WorldPosition at = core::normalised({{0, 0}, {x, 0, z}}, kShapedBlockM);
  return models::ground_height_m(terrain_parameters(world, at.block), at.block, at.local.x,
                                 at.local.z);
}

// Its finest ground has a vertex at every even metre.
template <class Visit>
void each_vertex(const Visit& visit) {
  for (int z = 0; z < 256; z += 4) {
    for (int x = 0; x < 512; x += 2)
      visit(static_cast<double>(x), static_cast<double>(z));
  }
}

// A road that bends and comes back near itself, and a stamp that it crosses.
inline constexpr const char* kShapes = R"(
[[stamp]]
image = "ramp.png"
centre_m = [128, 128]
size_m = 96
base_m = 4
height_m = 20
border_m = 16
turn_deg = 30

[[road]]
points_m = [[20, 30], [140, 140], [260, 60], [400, 200], [440, 150], [300, 90]]
width_m = 10
border_m = 8
clear_m = 2
)";

}  // namespace psygen::world::testing
