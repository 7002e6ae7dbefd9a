// The two vertex formats, written by modelers (engine/models) and read by the shaders
// (shaders/terrain.vert, shaders/model.vert). Seam between synthesis and rendering.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace psygen::core {

enum class VertexLayout : std::uint8_t { kTerrain = 0, kModel = 1 };

// Octahedral normals here fold about y (up). With s = |x| + |y| + |z| of the unit normal, the
// stored pair is (x, z) / s where y >= 0, else ((1 - |z|/s) · sign x, (1 - |x|/s) · sign z),
// sign(0) = 1. Decoding a pair (a, b): y = 1 - |a| - |b|, (x, z) = (a, b), or, where y < 0,
// ((1 - |b|) · sign a, (1 - |a|) · sign b); then normalise.

// A terrain vertex. Position in the block: x = grid_x · cell_m, z = grid_z · cell_m,
// y = height_min + height/65535 · height_range (the two figures are the same for the whole world,
// so that neighbouring blocks agree bit for bit). Bit 7 of grid_x marks a skirt vertex, which hangs
// below its twin by the skirt depth of the draw; the index itself is in bits 0–6 (0 … 127).
struct TerrainVertex {
  std::uint8_t grid_x;
  std::uint8_t grid_z;
  std::uint16_t height;         // unorm16 over the world's height range
  std::uint16_t coarse_height;  // height of the next coarser level here, for morphing
  std::int8_t normal_x;         // octahedral normal, snorm8 twice
  std::int8_t normal_z;
  std::uint8_t sun = 255;      // unorm8: visible share of the sun, 255 = unshadowed
  std::uint8_t ambient = 255;  // unorm8: visible share of the sky, 255 = open
  std::uint8_t cover = 0;      // spare: always 0, far forests are of a draw (TerrainDraw::cover)
  std::uint8_t spare = 0;
};
static_assert(sizeof(TerrainVertex) == 12);
inline constexpr std::uint8_t kTerrainSkirtBit = 0x80;

// A vertex of a tree, rock or any other model. Position is snorm16 within the mesh's box:
// p = center + half_extent · position / 32767, metres, local to the model's foot.
struct ModelVertex {
  std::int16_t position[3];
  std::uint8_t ambient;    // unorm8: baked ambient visibility, 255 = open sky
  std::uint8_t sway;       // unorm8: how much the wind moves it, 0 = not at all
  std::int16_t normal[2];  // octahedral, snorm16; see kBillboardBit
  std::uint8_t colour[3];  // linear-light albedo, stored with sqrt: albedo = (c/255)^2
  std::uint8_t material;   // 0 solid (bark, stone), 1 leaf (lit from both sides); kBillboardBit
};
static_assert(sizeof(ModelVertex) == 16);

// Of a material: the vertex turns about the vertical line through `position` towards the camera
// (for shadows the sun). `normal` says where it is then, to the right of that line and behind it as
// the camera sees it, in 1/32767 of kBillboardReachM metres. Its normal follows, as if it were
// rounded: to its side, to the camera, and up where it is behind the line.
inline constexpr std::uint8_t kBillboardBit = 2;
inline constexpr float kBillboardReachM = 256;
// No further from `position` than this does a vertex get by that, in metres.
constexpr float billboard_reach_m(const ModelVertex& v) {
  if ((v.material & kBillboardBit) == 0) return 0;
  const int right = v.normal[0], behind = v.normal[1];
  return static_cast<float>((right < 0 ? -right : right) + (behind < 0 ? -behind : behind)) *
         (kBillboardReachM / 32767.0F);
}

constexpr std::uint32_t vertex_stride_bytes(VertexLayout layout) {
  return layout == VertexLayout::kTerrain ? sizeof(TerrainVertex) : sizeof(ModelVertex);
}

// The bytes of a mesh as vertices of its layout.
template <class Vertex>
std::span<const Vertex> vertices_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const Vertex*>(bytes.data()), bytes.size() / sizeof(Vertex)};
}

}  // namespace psygen::core
