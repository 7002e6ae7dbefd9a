// Debug views: the colour of each draw, the legend of the colours, and lines around boxes. Pure.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/core/coordinates.hpp"
#include "engine/render/types.hpp"

namespace psygen::scene {

// The values of a draw that debug views show.
struct DrawFacts {
  std::uint32_t level = 0;    // of the node for ground and merged meshes, LOD for individual models
  std::uint32_t layer = 0;    // PLP layer of its node
  float bytes_per_m2 = 0;     // bytes of all meshes of its node, per ground area
  std::uint32_t coarser = 0;  // levels by which it is coarser than wanted
};

// Returns 0xRRGGBB. Levels: red, orange, yellow, green … from fine to coarse. Layers: bright to
// dark. Missing: green as wanted, yellow one level coarser, red more. Cache: dark blue below 1/16
// byte per square metre, over green to red from 64 on, each step a factor of four.
std::uint32_t colour_of(render::View view, const DrawFacts& facts);

// Returns the view's name, its subject and its colours, in lines of at most 40 characters; none for
// kNormal. `levels` of the quadtree; `edges`: the device can draw them (DeviceInfo::wireframe).
std::vector<render::TextLine> legend_of(render::View view, std::size_t levels, bool edges);

// Adds the twelve edges of a box.
void add_box(const core::Bounds& box, std::uint32_t colour, std::vector<render::Line>& lines);

}  // namespace psygen::scene
