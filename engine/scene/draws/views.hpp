// The views for understanding: what colour a draw has when it shows how the picture is made, the
// legend that says what the colours mean, and lines around what is drawn. Pure.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/core/coordinates.hpp"
#include "engine/render/types.hpp"

namespace psygen::scene {

// What a view may say about one draw.
struct DrawFacts {
  std::uint32_t level = 0;  // of the node for ground and merged meshes, of detail for single models
  std::uint32_t layer = 0;  // PLP layer of its node
  float bytes_per_m2 = 0;   // of the ground of its node, of all meshes drawn there
  std::uint32_t coarser = 0;  // by so many levels than what is wanted
};

// 0xRRGGBB. Levels: red, orange, yellow, green … from fine to coarse. Layers: bright to dark.
// Missing: green as wanted, yellow a level coarser, red more.
// Cache: dark blue below 1/16 byte per square metre, over green to red from 64 on, each step a
// factor of four.
std::uint32_t colour_of(render::View view, const DrawFacts& facts);

// The view's name, what it shows and its colours, in lines of at most 40 characters; none for
// kNormal. `levels` of the quadtree; `edges`: the device can draw them (DeviceInfo::wireframe).
std::vector<render::TextLine> legend_of(render::View view, std::size_t levels, bool edges);

// The twelve edges of a box.
void add_box(const core::Bounds& box, std::uint32_t colour, std::vector<render::Line>& lines);

}  // namespace psygen::scene
