// The textures of the ground, one for each kind of ground, which repeat without a seam: shares of
// the albedo that the world gives its ground, heights, normals and roughness, with mip levels.
// Computed once at start-up; the same on every machine. Pure, any thread. It makes no Vulkan image
// (frame/frame_sets.cpp), and decides nothing about where which kind is (shaders/ground.glsl).
// Private to engine/render.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/render/textures/ground_patterns.hpp"
#include "engine/render/types.hpp"

namespace psygen::render {

// The textures: first the kinds in the order of world::GroundKind, then scree, which lies at the
// foot of rock, then uneven patches of no kind, then the bark and the
// leaves of trees.
inline constexpr std::uint32_t kGroundTextures = 10;
// Layers of the array: of each texture the colour and height, then of each the normal.
inline constexpr std::uint32_t kGroundLayers = 2 * kGroundTextures;

// Mip levels down to one texel, each of kPatternSide texels per side, half as many, and so on: all
// layers of the level, row by row, four bytes per texel.
using GroundLevels = std::vector<std::vector<std::uint8_t>>;

// The array. Colours are factors of the albedo over 2 with a mean of 1/2, so what is far away keeps
// the colour that it has without textures; alpha is the height, 0 to 1. Normals: x and z (0 to 1
// for −1 to 1), roughness, and the share of the sky that reaches the texel. `pictures` take the
// place of textures of the same number; those without texels do not.
GroundLevels make_ground_layers(std::span<const GroundPicture> pictures = {});
// Layers for light per vertex, of brightness as factors over 2 with a mean of 1/2. First of ground:
// grass, forest floor, scree, sand. Then of models: the height of leaves, 0 to 1, which are high
// where they are dense, then brightness of bark, of rock and of leaves.
inline constexpr std::uint32_t kDetailLayers = 2;
GroundLevels make_ground_detail(std::span<const GroundPicture> pictures = {});

}  // namespace psygen::render
