// Hand-made meshes for tests and benchmarks of the renderer: a terrain grid, a box, a camera. Not
// procedural models.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "engine/render/renderer.hpp"

namespace psygen::render::synthetic {

// The scene of most tests: a small picture, and ground of so many vertices along a side.
inline constexpr core::Extent kPictureSize{160, 120};
inline constexpr int kGroundSide = 65;

// A headless renderer for pictures of a preset, with validation and 1 MiB for geometry.
core::Result<std::unique_ptr<Renderer>> open_renderer(Preset preset,
                                                      core::Extent size = kPictureSize);

// Height in [0, 1] at grid line (x, z).
using HeightFunction = std::function<float(int x, int z)>;

// (side − 1)² · 2 triangles over a grid of side² vertices, counter-clockwise from above.
std::vector<std::uint16_t> grid_indices(int side);

// A committed terrain mesh of side² vertices without indices of its own. side <= 128.
core::Result<core::GeometryRange> make_terrain(core::GeometryMemory& memory, int side,
                                               const HeightFunction& height);

// A committed box that fills its bounds, 24 vertices and 36 indices, of one linear albedo and one
// ModelVertex::material.
core::Result<core::GeometryRange> make_box(core::GeometryMemory& memory, glm::vec3 albedo,
                                           std::uint8_t material = 0);

// The same as an object. Each side shows a whole texture.
core::Result<core::GeometryRange> make_object_box(core::GeometryMemory& memory, glm::vec3 albedo);

// A grid of side² vertices in the box as a model mesh with its own indices: many small triangles.
core::Result<core::GeometryRange> make_sheet(core::GeometryMemory& memory, int side);
// The same as an object.
core::Result<core::GeometryRange> make_object_sheet(core::GeometryMemory& memory, int side);

// A camera at height `altitude_m` that looks along −Z, `pitch` radians up, over meadows and rock.
FrameInput look(double altitude_m, double pitch, core::Extent size);

}  // namespace psygen::render::synthetic
