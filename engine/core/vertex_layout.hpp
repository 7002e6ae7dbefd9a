// The three vertex formats, and the texture format of impostors. Modelers (engine/models) write
// them and shaders read them (shaders/terrain.vert, shaders/model.vert). The interface between
// synthesis and rendering: byte layouts, no behaviour. Any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace psygen::core {

// The format of a mesh's vertices.
enum class VertexLayout : std::uint8_t { kTerrain = 0, kModel = 1, kObject = 2 };

// Octahedral normals here fold about y (up). With s = |x| + |y| + |z| of the unit normal, the
// stored pair is (x, z) / s where y >= 0, else ((1 - |z|/s) · sign x, (1 - |x|/s) · sign z),
// sign(0) = 1. Decoding a pair (a, b): y = 1 - |a| - |b|, (x, z) = (a, b), or, where y < 0,
// ((1 - |b|) · sign a, (1 - |a|) · sign b); then normalise.

// A terrain vertex. Its position in the block is x = grid_x · cell_m, z = grid_z · cell_m, y =
// height_min + height/65535 · height_range. Both heights are the same for the whole world, so
// neighbouring blocks agree bit for bit. Bit 7 of grid_x marks a skirt vertex, which hangs below
// its twin by the skirt depth of the draw; bits 0–6 hold the index (0 … 127).
struct TerrainVertex {
  std::uint8_t grid_x;
  std::uint8_t grid_z;
  std::uint16_t height;         // unorm16 over the world's height range
  std::uint16_t coarse_height;  // height of the next coarser level here, for morphing
  std::int8_t normal_x;         // octahedral normal, snorm8 twice
  std::int8_t normal_z;
  std::uint8_t sun = 255;      // unorm8: visible fraction of the sun, 255 = unshadowed
  std::uint8_t ambient = 255;  // unorm8: visible fraction of the sky, 255 = open
  std::uint8_t wet = 0;        // unorm8: how wet banks and beds are
  std::uint8_t road = 0;       // unorm8: fraction covered by a road, or by gravel beside water
};
static_assert(sizeof(TerrainVertex) == 12);
// Bit 7 of TerrainVertex::grid_x.
inline constexpr std::uint8_t kTerrainSkirtBit = 0x80;

// A vertex of a tree, a rock or any other model. `position` is snorm16 within the mesh's box: p =
// centre + half_extent · position / 32767, in metres relative to the model's base point.
struct ModelVertex {
  std::int16_t position[3];
  std::uint8_t ambient;    // unorm8: baked ambient visibility, 255 = open sky
  std::uint8_t sway;       // unorm8: strength of the wind's effect, 0 = none
  std::int16_t normal[2];  // octahedral, snorm16; see kBillboardBit
  std::uint8_t colour[3];  // linear-light albedo, stored with sqrt: albedo = (c/255)^2
  std::uint8_t material;   // 0 solid (bark, stone), 1 leaf (lit from both sides); bits below
};
static_assert(sizeof(ModelVertex) == 16);

// A vertex of the surface of a river or lake, in the bytes of a ModelVertex: meshes of water have
// the layout kModel, and only the renderer's water pass draws them.
struct WaterVertex {
  std::int16_t position[3]{};  // snorm16 within the mesh's box, as of ModelVertex
  std::uint8_t depth = 0;      // of the water under it: (depth / 255)² · kWaterVertexDepthM
  std::uint8_t foam = 0;       // unorm8: fraction of the surface that foams
  std::int16_t flow[2]{};      // snorm16: velocity along x and z, in kWaterVertexSpeed m/s
  std::int8_t slope[2]{};      // snorm8: slope of the surface along x and z
  std::uint16_t unused = 0;
};
static_assert(sizeof(WaterVertex) == sizeof(ModelVertex));
inline constexpr float kWaterVertexDepthM = 16, kWaterVertexSpeed = 8;  // m, m/s

// A vertex of a game's own object: a model's vertex and its texture coordinates.
struct ObjectVertex {
  ModelVertex model;
  float uv[2];  // (0, 0) is the corner of a texture's first texel; the texture repeats outside of
                // [0, 1]
};
static_assert(sizeof(ObjectVertex) == 24);

// A bit of ModelVertex::material. The vertex turns about the vertical line through `position` to
// face the camera (in shadow maps, the sun). `normal` then holds its offset from that line as the
// camera sees it, to the right and behind, in units of kBillboardReachM / 32767 metres. The shading
// normal is that of a rounded surface: towards the vertex's side, towards the camera, and up when
// the vertex is behind the line.
inline constexpr std::uint8_t kBillboardBit = 2;
inline constexpr float kBillboardReachM = 256;
// A bit that only occurs together with kBillboardBit: the vertex is a corner of an impostor
// (kImpostorSide). `colour` then holds kImpostorViews · impostor index + number of views by
// which the model is turned, and the texture coordinates u and v.
inline constexpr std::uint8_t kImpostorBit = 4;
// Upper bound of the distance by which billboard rotation moves the vertex from `position`, in
// metres.
constexpr float billboard_reach_m(const ModelVertex& v) {
  if ((v.material & kBillboardBit) == 0) return 0;
  const int right = v.normal[0], behind = v.normal[1];
  return static_cast<float>((right < 0 ? -right : right) + (behind < 0 ? -behind : behind)) *
         (kBillboardReachM / 32767.0F);
}

// The material of all of a model except its leaves, which chooses its textures. The shaders use the
// same numbers (PSYGEN_SURFACE_…).
enum class SurfaceKind : std::uint8_t {
  kPlain = 0,  // vertex colours only
  kStone = 1,
  kBark = 2,
  kWater = 4,  // a surface of WaterVertex; 3 is that of leaves in shaders
};

// Bytes per vertex of a layout.
constexpr std::uint32_t vertex_stride_bytes(VertexLayout layout) {
  switch (layout) {
    case VertexLayout::kTerrain:
      return sizeof(TerrainVertex);
    case VertexLayout::kObject:
      return sizeof(ObjectVertex);
    default:
      return sizeof(ModelVertex);
  }
}

// The bytes of a mesh as vertices. `Vertex` is the type of the mesh's layout.
template <class Vertex>
std::span<const Vertex> vertices_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const Vertex*>(bytes.data()), bytes.size() / sizeof(Vertex)};
}

// Impostors stand in for distant models: views from around the model, one after the other in one
// texture. Synthesis makes them (world/far/tree_impostors.hpp), and the renderer draws them.
// Texels of 4 bytes: red, green and blue as the square root of the linear albedo, and opacity,
// which is drawn from one half on. The texture stores level by level, each half as wide as the one
// before; in a level view by view; in a view rows from the top. View k shows the model to a viewer
// who looks along (cos, 0, sin) of k · 45°.
inline constexpr std::uint32_t kImpostorSide = 128;  // texels
inline constexpr std::uint32_t kImpostorViews = 8;
inline constexpr std::uint32_t kImpostorLevels = 6;  // the last one has 4 x 4 texels
// Limit of the renderer: one byte holds an impostor and a view, and every device has as many
// layers.
inline constexpr std::uint32_t kMaxImpostors = 31;

// The texels of one impostor.
using ImpostorTexture = std::vector<std::uint8_t>;

// Bytes of one level of all views, and of a whole impostor.
constexpr std::size_t impostor_level_bytes(std::uint32_t level) {
  const std::size_t side = kImpostorSide >> level;
  return kImpostorViews * side * side * 4;
}
constexpr std::size_t impostor_bytes() {
  std::size_t sum = 0;
  for (std::uint32_t level = 0; level < kImpostorLevels; ++level)
    sum += impostor_level_bytes(level);
  return sum;
}

}  // namespace psygen::core
