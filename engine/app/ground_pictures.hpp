// Reads the images that replace the ground textures of a world, from the folder of its file.
// Creates no textures (render/types.hpp). Any thread; too slow for the
// tick.
#pragma once

#include <array>
#include <filesystem>

#include "engine/core/error.hpp"
#include "engine/render/types.hpp"

namespace psygen::world {
struct World;
}

namespace psygen::app {

// Replacement images by kind of ground; empty where the world has none.
using GroundPictures = std::array<render::GroundPicture, render::kGroundPictures>;

// Reads the images of world::Palette::images. Error messages begin with the world's file and the
// field, and have the code of image::read_image() or render::ground_picture(). Also fails with
// kInvalidArgument if a link leads out of the folder.
core::Result<GroundPictures> read_ground_pictures(const world::World& world,
                                                  const std::filesystem::path& world_file);

}  // namespace psygen::app
