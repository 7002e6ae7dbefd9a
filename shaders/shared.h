// The structures that GLSL and C++ share, each declared once. They have only vec4 and mat4, so
// std140, std430 and C++ agree without padding. Units: metres, seconds, linear light multiplied by
// the exposure. Positions are relative to the camera; directions are in world space.
#ifndef PSYGEN_SHADERS_SHARED_H
#define PSYGEN_SHADERS_SHARED_H

#ifdef __cplusplus
#include <cstddef>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
namespace psygen::shaders {
using glm::mat4;
using glm::vec4;
#endif

// Bindings of set 0, which all passes share.
#define PSYGEN_BINDING_FRAME 0
#define PSYGEN_BINDING_DRAWS 1
#define PSYGEN_BINDING_CLOUDS 2
#define PSYGEN_BINDING_SHADOWS 3
#define PSYGEN_BINDING_MATERIALS 4
#define PSYGEN_BINDING_GROUND 5
#define PSYGEN_BINDING_SHADE 6
#define PSYGEN_BINDING_PICTURES 7

// Bindings of set 1: the textures of a material.
#define PSYGEN_TEXTURE_BASE 0
#define PSYGEN_TEXTURE_NORMAL 1
#define PSYGEN_TEXTURE_EMISSIVE 2

// Bindings of set 2, of each pass that has one.
#define PSYGEN_REFLECTION_COLOUR 0
#define PSYGEN_REFLECTION_DEPTH 1
#define PSYGEN_PARTICLE_EMITTER 0
#define PSYGEN_LINE_ENDS 0
#define PSYGEN_OVERLAY_FONT 0
#define PSYGEN_OVERLAY_VERTICES 1
// The texture in the only set of scale_up.glsl, beside PSYGEN_BINDING_FRAME.
#define PSYGEN_SCALE_UP_LANDSCAPE 1

// Bits of MaterialData::options.x.
#define PSYGEN_MATERIAL_NORMAL_MAP 1u
#define PSYGEN_MATERIAL_TWO_SIDED 2u

// The textures of the ground (ground_textures.hpp): texels per side, how often they repeat in the
// period of the slow pattern, that period in metres, and up to how many metres from the camera
// presets without fine grain draw them.
#define PSYGEN_GROUND_SIDE 256
#define PSYGEN_GROUND_REPEATS 976
#define PSYGEN_GROUND_PERIOD_M 2048
#define PSYGEN_NEAR_GROUND_M 64
// Its layers: of each texture the colour, then of each the normal. The first are the kinds of
// ground (world::GroundKind).
#define PSYGEN_TEXTURE_ROCK 4
#define PSYGEN_TEXTURE_SCREE 6
#define PSYGEN_TEXTURE_PATCHES 7
#define PSYGEN_TEXTURE_BARK 8
#define PSYGEN_TEXTURE_LEAVES 9
#define PSYGEN_GROUND_TEXTURES 10
// Materials of models (core::SurfaceKind).
#define PSYGEN_SURFACE_STONE 1
#define PSYGEN_SURFACE_BARK 2
#define PSYGEN_SURFACE_LEAVES 3  // those of bark
// Where the texture of leaves is lower than this there are gaps between them.
#define PSYGEN_LEAF_GAPS 0.36
// With light per vertex, models up to so many metres from the camera have this layer of textures
// (make_ground_detail). Its channels: 0 how high leaves are, brightness of 1 bark, 2 stone, 3
// leaves.
#define PSYGEN_NEAR_MODELS_M 128
#define PSYGEN_LAYER_OF_MODELS 1
// Cells of one metre along each side of the map of dark spots on near ground
// (meshes/contact_shadow_map.hpp).
#define PSYGEN_SHADE_SIDE 128

// Materials of objects, and a factor by which DrawData carries their number beside the wind.
#define PSYGEN_MAX_MATERIALS 4096

// Largest number of cascades of the sun's shadow.
#define PSYGEN_MAX_CASCADES 3

// Most point lights of a frame.
#define PSYGEN_MAX_LAMPS 40

// Vertices of a particle (particle.glsl): two triangles.
#define PSYGEN_PARTICLE_VERTICES 6

// Vertices that turn towards the camera: core::kBillboardBit and kBillboardReachM.
#define PSYGEN_BILLBOARD_BIT 2u
#define PSYGEN_BILLBOARD_REACH_M 256.0

// Vertices of pictures (core::kImpostorBit), and the views around a model that a picture has. Layer
// 0 of the texture is white; from there on, the views follow each other.
#define PSYGEN_PICTURE_BIT 4u
#define PSYGEN_PICTURE_VIEWS 8

// The plane of water (water.vert): columns around, rings from the camera to the horizon, vertices
// of a column, radius in metres.
#define PSYGEN_WATER_COLUMNS 28
#define PSYGEN_WATER_RINGS 26
#define PSYGEN_WATER_STRIP (2 * (PSYGEN_WATER_RINGS + 1) + 2)
#define PSYGEN_WATER_REACH 500000.0

// Values of core::WaterVertex: depth of 255, speed of a flow of 32767 in m/s.
#define PSYGEN_WATER_DEPTH_M 16.0
#define PSYGEN_WATER_SPEED 8.0

// The sky dome of preset low (sky_dome.vert): columns around, rows from the horizon to the top,
// vertices of a column; and the sides of the pyramid below it (sky_below.vert).
#define PSYGEN_DOME_COLUMNS 24
#define PSYGEN_DOME_ROWS 14
#define PSYGEN_BELOW_SIDES 6
#define PSYGEN_DOME_STRIP (2 * PSYGEN_DOME_ROWS + 2)

// The square around the sun that is drawn over the dome: half of a side, and the cosine of the
// angle at which it ends.
#define PSYGEN_SUN_REACH 0.035
#define PSYGEN_SUN_EDGE 0.99942

// The data of a frame.
struct FrameData {
  mat4 clip_from_camera;  // camera-relative world to clip space, reversed infinite depth
  vec4 ray_right;  // direction of a pixel = ray_forward + ndc.x · ray_right + ndc.y · ray_down
  vec4 ray_down;
  vec4 ray_forward;
  vec4 sun_direction;    // unit, towards the sun; w: seconds for wind and waves
  vec4 sun_colour;       // w: exposure
  vec4 zenith_colour;    // w: fall-off of the haze with height, 1/m
  vec4 horizon_colour;   // w: height of the camera, m
  vec4 ground_colour;    // light from below; w: strength of the ground pattern, 0 or 1
  vec4 haze_colour;      // w: cloud cover, 0 to 1
  vec4 ground_anchor;    // x, y: camera in the ground pattern, m; z, w: size of the picture, pixels
  vec4 grass;            // palette, linear; w: height where sand ends, m
  vec4 forest;           // w: height where dry meadow starts, m
  vec4 dry;              // w: blend of the dry meadow, m
  vec4 rock;             // w: slope (1 − normal.y) where rock starts
  vec4 snow;             // w: slope where everything is rock
  vec4 sand;             // w: blend of the sand, m
  vec4 snow_line;        // x: height where snow starts, m; y: blend, m; z: slope without snow
  vec4 glow_colour;      // around the sun
  vec4 glow_direction;   // towards the centre of the glow, not below the horizon
  vec4 cloud_colour;     // sun on clouds
  vec4 haze_extinction;  // at the camera's height, 1/m, for red, green, blue
  vec4 water;            // albedo of deep water; w: height of the surface above the camera, m
  vec4 deep_water;       // light from the depth of water
  vec4 water_loss;       // loss of light for each metre of depth (under_water.glsl), 1/m
  vec4 clouds;           // x, y: camera in the texture of clouds; z: repeats of it, 1/m
  vec4 canopy;           // albedo of far forests; w: slope without forests
  vec4 canopy_place;     // x: height where forests start, y: end, m; z: 1 / blend, 1/m
  vec4 morph;   // of draws with a negative morph; x: distance where it begins, m; y: 1 / length,
                // 1/m; z: of the pattern of fades, 0 to 1 (fading.glsl)
  vec4 edge;    // of the world: least x, least z, greatest x, greatest z
  vec4 shadow;  // x: texel of a shadow map, 0 to 1; y: cascades, 0 to 3
  vec4 shadow_reach;  // largest distance from the camera of each cascade, m
  vec4 shade;  // x, y: corner of the map of dark spots, m; z, w: size of the landscape, pixels
  mat4 shadow_from_camera[PSYGEN_MAX_CASCADES];  // to texture and depth, nearest cascade first
  vec4 lamp_count;                               // x: lamps
  vec4 lamps[2 * PSYGEN_MAX_LAMPS];  // place, 1 / range² in 1/m²; light on what faces it at 1 m
};

// The data of a draw.
// Terrain: x, z = origin + cell · grid; y = origin.y + range · height.
// Models:  p = centre + half_extent · position.
// Objects: p = centre + turn · (half_extent · position).
// In views that colour draws, the cover of terrain and the phase of models are replaced by the
// debug colour: red · 65536 + green · 256 + blue.
struct DrawData {
  vec4 origin;  // terrain: origin, w cell size in m; model: centre, w phase of the wind, 0 to 1;
                // object: the same, w number of the material + phase
  vec4 scale;  // terrain: height range, skirt, morph or < 0 (FrameData), cover; model: half extent,
               // w fade (fading.glsl), 1 if it does not fade
  vec4 light;  // x: share of the sun that no terrain hides; model: y PSYGEN_SURFACE_…; object: y,
               // z, w 1 / scale
  vec4 turn;   // object: unit quaternion
};

// A material of objects. Colours are linear; the emitted light is before the exposure.
struct MaterialData {
  vec4 base;      // albedo, opacity; multiplied by the colours of vertices and texture
  vec4 emissive;  // w: least opacity that is drawn, 0: all is
  vec4 options;   // x: bits; y: strength of the normal map
};

// An emitter of particles (particle.glsl; render::ParticleKind has the meaning of the parts).
struct EmitterData {
  vec4 origin;        // of the volume; w: share of its cycle that the first particle has passed
  vec4 axis_x;        // half axes of the volume, m; w: particles
  vec4 axis_y;        // w: lifetime, s
  vec4 axis_z;        // w: variation of lifetimes
  vec4 velocity;      // m/s; w: spread, m/s
  vec4 wind;          // m/s; w: gravity, m/s²
  vec4 first_colour;  // at the beginning of a life, with opacity
  vec4 last_colour;   // at its end
  vec4 size;          // x: first, y: last, m; z: variation; w: s of motion that a streak shows
  vec4 shape;         // x: fade in, y: fade out, shares of a life; z: softness; w: width / height
  vec4 motion;        // x: drag, 1/s; y: turbulence, m; z: spin, rad/s; w: tumbling, rad/s
  vec4 light;         // x: share of the sun; y: opacity of all; z: glow; w: share that it covers
  vec4 names;         // x: seed of this generation, y: of the next; z: youngest, w: oldest age, s
  vec4 around;  // edges of the box around the camera that particles stay in, or 0; w: variation of
                // brightness
  vec4 cycle;   // x: s from a birth of a particle to its next one
  vec4 spare;   // to 256 bytes, the largest alignment of offsets that devices ask for
};

// A corner of a quad of the overlay, or an end of a line.
struct OverlayVertex {
  vec4 place;   // pixels x, y; texture u, v; for lines: metres, relative to the camera
  vec4 colour;  // display values, not linear; a: opacity
  // For letters that are signed distances: texels from the least to the greatest distance (0: plain
  // coverage), pixels by which they are thicker, pixels of their edge.
  vec4 look;
};

#ifdef __cplusplus
static_assert(sizeof(FrameData) == 64 + 32 * 16 + 3 * 64 + 16 + PSYGEN_MAX_LAMPS * 32);
static_assert(sizeof(DrawData) == 64);
static_assert(sizeof(MaterialData) == 48);
static_assert(sizeof(EmitterData) == 256);
static_assert(sizeof(OverlayVertex) == 48);
static_assert(offsetof(FrameData, ray_right) == 64);
}  // namespace psygen::shaders
#endif
#endif
