// Inputs of the renderer (options, light, palette, draws) and its results. Plain values without any
// Vulkan type, any thread. Units are metres and seconds, colours are linear, positions are relative
// to the camera. It does nothing itself (renderer.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/camera.hpp"
#include "engine/core/error.hpp"
#include "engine/core/geometry_memory.hpp"
#include "engine/core/surface_provider.hpp"
#include "engine/core/vertex_layout.hpp"
#include "engine/render/hud_drawing.hpp"

struct ImDrawData;

namespace psygen::render {

// Submission of draws: many per call with their data in a buffer (kMultiDraw), or one per call
// with its data in push constants (kPushed). A pushed draw is more expensive, but its vertices are
// cheaper on software devices. kAuto: multi-draw on hardware; on software devices by mesh size.
enum class Submission : std::uint8_t { kAuto, kMultiDraw, kPushed };

// Where culling and the choice of levels of detail run: on the CPU, or on the device, which then
// also culls hidden meshes (gpu_culling.hpp). kAuto: on the device, except software devices.
enum class RenderPath : std::uint8_t { kAuto, kCpu, kGpu };

// The way into device memory: the CPU writes meshes directly, or writes its own memory, which is
// copied. kAuto: directly, if the device has enough memory that the CPU can write.
enum class Upload : std::uint8_t { kAuto, kDirect, kStaged };

// The amount of light and detail in a picture. preset.hpp and docs/presets.md list the differences.
enum class Preset : std::uint8_t { kLow, kMedium, kHigh, kUltra };

// Parts of the renderer whose pipelines are created when they are first needed, except those of the
// landscape (Renderer::prepare()).
enum class Feature : std::uint8_t { kLandscape, kObjects, kPointLights, kParticles };

// The content of a picture: the landscape, or a view for debugging.
enum class View : std::uint8_t {
  kNormal,
  kLevels,     // each draw in its `debug_colour`, for its level of detail
  kLayers,     // the same, for its layer of visibility
  kBounds,     // the landscape with the frame's lines
  kWireframe,  // edges of triangles; the landscape if the device cannot draw them
  kMissing,    // each draw in its `debug_colour`, for its difference from the wanted level
  kCache,      // the same, for its share of the geometry cache
};

// Kinds of ground with a texture that can be replaced, in the order of world::GroundKind.
inline constexpr std::size_t kGroundPictures = 6;
// An image in place of a ground texture: 256 × 256 texels of red, green and blue, 0 to 1 and
// linear, row by row. Empty: the texture stays.
struct GroundPicture {
  std::vector<float> rgb;
};
// Pixels along each side of a picture for ground_picture().
inline constexpr std::uint32_t kMinGroundPicture = 16, kLargestGroundPicture = 4096;
// Makes such an image of a picture. `rgba`: 8 bits of each, as displayed, row by row. Fails with
// kInvalidArgument, and a sentence about the picture, if it is not square, too small or too large,
// has transparent pixels, is black in red, green or blue, or shows a seam where it is repeated.
core::Result<GroundPicture> ground_picture(std::uint32_t width, std::uint32_t height,
                                           std::span<const std::uint8_t> rgba);

// Called with the progress of a long operation, a fraction in [0, 1]. Returning false cancels it.
// May be empty.
using Progress = std::function<bool(double)>;

class Renderer;

// The options of Renderer::create().
struct RendererOptions {
  std::string application_name = "psygen";
  std::string device_name;  // index, UUID or part of the name (list_devices()); empty: the best
  bool validation = false;  // Khronos layer with synchronization validation; messages are collected
  core::Extent size{1280, 720};  // of the picture; with a surface it is that of the framebuffer
  std::uint64_t geometry_budget_bytes = 512ull << 20;  // hard limit of geometry()
  core::SurfaceProvider* surface = nullptr;  // null: headless; else it must outlive the renderer
  bool vsync = false;
  Submission submission =
      Submission::kAuto;  // kMultiDraw without DeviceInfo::multi_draw is kPushed
  RenderPath path = RenderPath::kAuto;
  Upload upload = Upload::kAuto;
  bool occlusion = true;  // on the GPU path: cull what was hidden in the last frame and still is
  std::optional<Preset> preset;  // none: kLow on software devices, kHigh on others
  // Called while the pipelines are created, which takes seconds if the driver has not cached them.
  // It may only call show() of the renderer. If it returns false, create() fails with kInterrupted.
  std::function<bool(Renderer&, double)> progress;
  double device_timeout_seconds = 60;  // longest wait for the device; after that it counts as lost
  bool timestamps = true;              // FrameResult::gpu, if the device supports it
  // GpuTime::pass_ms, if the device has timestamps. None: not on software devices, which finish all
  // drawing at each timestamp.
  std::optional<bool> pass_times;
  std::uint64_t texture_budget_bytes =
      256ull << 20;  // hard limit of all textures of materials and pictures
  std::array<GroundPicture, kGroundPictures> ground;  // in place of textures of the ground
};

// The type of a device, from the least to the most preferred.
enum class DeviceType : std::uint8_t { kOther, kSoftware, kVirtual, kIntegrated, kDiscrete };

// A device and its abilities.
struct DeviceInfo {
  std::string name;         // "llvmpipe (LLVM 15.0.6, 256 bits)"
  std::string uuid;         // "6d657361-3232-2e33-2e36-2d3100000000"
  std::string driver;       // name and version
  std::string api_version;  // "1.3.230"
  DeviceType type = DeviceType::kOther;
  std::uint64_t memory_bytes = 0;    // of all device-local heaps
  std::vector<std::string> missing;  // needed by every renderer; empty: the device can be used
  bool multi_draw = false;           // many meshes in one call
  bool gpu_path = false;             // RenderPath::kGpu can be used
  bool wireframe = false;            // View::kWireframe can be drawn
  // Known only of the renderer's device:
  std::uint64_t max_allocation_bytes = 0;
  std::uint32_t max_image_side = 0;  // pixels
  bool timestamps = false;           // FrameResult::gpu is known
  bool pass_times = false;           // GpuTime::pass_ms is known

  // True if it draws with the processors of the machine.
  bool software() const { return type == DeviceType::kSoftware; }
  // True if shaders can know the number of a draw. Otherwise every draw is pushed.
  bool numbers_draws() const { return multi_draw || gpu_path; }
};

// Sun, sky and air. Colours are linear radiance before `exposure`.
struct Light {
  glm::vec3 sun_direction{0.45F, 0.55F, 0.35F};  // towards the sun; need not be unit
  glm::vec3 sun_colour{2.35F, 2.00F, 1.55F};
  glm::vec3 zenith_colour{0.085F, 0.20F, 0.50F};
  glm::vec3 horizon_colour{0.34F, 0.47F, 0.66F};
  glm::vec3 ground_colour{0.11F, 0.10F, 0.07F};  // light from below
  glm::vec3 haze_colour{0.50F, 0.58F, 0.69F};    // the sky just above (and below) the horizon
  glm::vec3 glow_colour{2.35F, 2.00F, 1.55F};    // of the sky around the sun
  glm::vec3 cloud_colour{2.35F, 2.00F, 1.55F};   // of the sun on clouds
  float haze_density = 0.0012F;                  // 1/m at height 0; at 1/density 37 % is left
  glm::vec3 haze_tint{0.82F, 1.0F, 1.3F};  // extinction of red, green and blue over haze_density
  float haze_height_falloff = 0.004F;      // 1/m; 0: the same at every height
  float exposure = 1.0F;
  float time_seconds = 0.0F;  // for wind and clouds
  float cloud_cover = 0.5F;   // 0 clear … 1 overcast
};

// A plane of water to the horizon.
struct WaterPlane {
  float level_m = 0.0F;                      // height in the world
  glm::vec3 colour{0.010F, 0.045F, 0.050F};  // linear albedo of deep water
};

// The canopy of forests too far away to be drawn. It hides the share TerrainDraw::cover of the
// ground.
struct Canopy {
  glm::vec3 colour{0.022F, 0.040F, 0.012F};  // linear albedo, from above
  float lowest_m = -1e6F, highest_m = 1e6F;  // heights in the world between which it grows
  float blend_m = 20.0F;                     // width of the transition at these heights
  float slope_max = 0.30F;                   // 1 − normal.y
};

// The rectangle of the world in x and z, relative to the camera. Vertices of terrain outside are
// moved onto its edge.
struct WorldEdge {
  glm::vec2 least{-1e30F}, greatest{1e30F};
};

// Linear albedos of the ground, and the extent of each kind of ground. Heights are in metres of the
// world. Slope is 1 − normal.y: 0 flat, 0.29 at 45°, 1 vertical. The defaults are black: the
// values come from the world (world::Palette).
struct TerrainPalette {
  glm::vec3 grass{0.0F}, forest{0.0F}, dry{0.0F}, rock{0.0F}, snow{0.0F}, sand{0.0F};
  float sand_end_m = 0, sand_blend_m = 0;    // sand below this height
  float dry_start_m = 0, dry_blend_m = 0;    // dry meadow above this height
  float snow_start_m = 0, snow_blend_m = 0;  // snow above this height, except where steep
  float rock_slope_start = 0, rock_slope_full = 0;
  float snow_slope_max = 0;  // no snow on steeper ground
};

// The id for "no shared list": the mesh has its own indices.
inline constexpr std::uint32_t kNoSharedIndices = 0;

// Presets without fine grain draw detail on the ground up to this distance from the camera.
inline constexpr float kNearGroundM = 64.0F;
// Presets with light per vertex draw detail on models up to this distance, less beyond half of it.
inline constexpr float kNearModelsM = 128.0F;

// Largest displacement of a vertex by the wind in metres, in both directions (shaders/model.vert).
inline constexpr glm::vec3 kSwayM{0.12F, 0.0F, 0.09F};

// A tree, rock or any other mesh of core::VertexLayout::kModel. With `fade` in (0, 1) it covers
// this share of its pixels. With `fade` in (−1, 0] it covers the pixels that a draw with −fade
// leaves out, so one mesh can fade out while another fades in.
struct MeshDraw {
  core::GeometryRange range;
  std::uint32_t shared_indices = kNoSharedIndices;  // from upload_shared_indices
  glm::vec3 origin{0.0F};                           // the mesh's foot
  glm::vec3 box_centre{0.0F};                       // box of the snorm16 positions, from the foot
  glm::vec3 box_half_extent{1.0F};
  core::IndexPart part;   // of its indices; empty: all
  float fade = 1.0F;      // 1: all of its pixels
  bool pictured = false;  // vertices may have core::kImpostorBit
  bool near = false;      // nearer than kNearModelsM: with more detail if the preset has it
  core::SurfaceKind surface = core::SurfaceKind::kPlain;  // of all but leaves
  float sun = 1.0F;                       // share of the sun that no terrain hides, 0 … 1
  std::uint32_t debug_colour = 0x808080;  // 0xRRGGBB, in the views that colour draws
};

// A grid of core::VertexLayout::kTerrain.
struct TerrainDraw {
  core::GeometryRange range;
  std::uint32_t shared_indices = kNoSharedIndices;
  glm::vec3 origin{0.0F};                            // the block's corner at world height 0
  float cell_m = 1.0F;                               // between two grid lines
  float height_min_m = 0.0F, height_range_m = 1.0F;  // range of the unorm16 heights
  float skirt_m = 0.0F;                              // length of the skirts
  float morph = 0.0F;    // 0 fine heights … 1 coarse heights; kMorphByDistance: FrameInput::morph
  core::IndexPart part;  // of the shared list; empty: all of it
  float side_m = 0.0F;   // of the square that the grid covers; 0: the largest possible grid
  float cover = 0.0F;    // share of the ground that far forests hide (Canopy)
  bool near = false;     // some of it is nearer than kNearGroundM: drawn with more detail
  std::uint32_t debug_colour = 0x808080;  // 0xRRGGBB, in the views that colour draws
};

// Names of a texture and of a material (Renderer::add_texture, add_material). kNoTexture is none;
// kPlainMaterial is white, solid and has no textures.
using TextureId = std::uint32_t;
using MaterialId = std::uint32_t;
inline constexpr TextureId kNoTexture = 0;
inline constexpr MaterialId kPlainMaterial = 0;

// The look of an object's surface. All parts are multiplied: the colours of its vertices, of the
// material and of the texture.
struct Material {
  glm::vec3 base_colour{1.0F};  // linear albedo
  float opacity = 1.0F;         // together with the texture's alpha; compared with min_opacity
  float min_opacity = 0.0F;     // pixels of less opacity are left out; 0: all are drawn
  glm::vec3 emissive{0.0F};     // light that it emits, before the exposure; sunlit white is 1 to 2
  TextureId base_texture = kNoTexture;
  TextureId normal_texture = kNoTexture;    // +Y up, as in glTF
  TextureId emissive_texture = kNoTexture;  // multiplied by `emissive`
  float normal_strength = 1.0F;
  bool two_sided = true;  // normals turn towards the camera; both sides are drawn in any case
};

// Pixels for a texture: rows from the top, 4 bytes per pixel (red, green, blue, alpha).
struct TexturePixels {
  std::uint32_t width = 0, height = 0;
  std::span<const std::uint8_t> rgba;
  bool colours = true;  // sRGB; false: numbers, as in normal maps
};

// An object of the game: a mesh of core::VertexLayout::kObject, turned and scaled. `fade` as of
// MeshDraw.
struct ObjectDraw {
  core::GeometryRange range;
  MaterialId material = kPlainMaterial;
  glm::vec3 origin{0.0F};                                 // of the mesh, relative to the camera
  std::array<float, 4> rotation{0.0F, 0.0F, 0.0F, 1.0F};  // unit quaternion x, y, z, w
  glm::vec3 scale{1.0F};                                  // not 0; before the rotation
  glm::vec3 box_centre{0.0F};                             // box of the snorm16 positions
  glm::vec3 box_half_extent{1.0F};
  float fade = 1.0F;
  float sun = 1.0F;                       // share of the sun that no terrain hides, 0 … 1
  float phase = 0.0F;                     // of the wind, 0 … 1
  std::uint32_t name = 0;                 // differs between objects; for occlusion culling
  std::uint32_t debug_colour = 0x808080;  // 0xRRGGBB, in the views that colour draws
};

// A light that shines in all directions, without shadows. It falls off with the square of the
// distance, smoothly to nothing at `range_m`, and is half a metre across.
struct PointLight {
  glm::vec3 position{0.0F};  // relative to the camera
  float range_m = 10.0F;     // > 0
  // On a surface that faces it from 1 m away, before the exposure; the sun at noon gives about 2.
  glm::vec3 light{1.0F};
};
inline constexpr std::size_t kMaxPointLights = 40;

// Particles: how those of a kind are born, move and look, and an emitter of a frame. The device
// computes every particle from these, its number and the time (shaders/particle.glsl); nothing is
// simulated or kept.
// Bounds of a frame: particles of an emitter and of all, and emitters.
inline constexpr std::uint32_t kMaxParticlesPerEmitter = 8192;
inline constexpr std::uint32_t kMaxParticles = 65536;
inline constexpr std::uint32_t kMaxEmitters = 256;
// The smallest drag that is computed, 1/s: closed forms of motion divide by the drag.
inline constexpr float kMinParticleDrag = 0.01F;

// Where particles are born. kBox: in a box around the emitter, or at a point if that has no size.
// kAroundCamera: everywhere, drawn in a box around the camera; for rain and snow. The emitter's
// place does not matter then.
enum class ParticleVolume : std::uint8_t { kBox, kAroundCamera };

// A kind of particles. All lengths and speeds are those of an emitter without scale. Directions of
// `half_extent_m` and `velocity` are turned with the emitter; gravity and wind are the world's.
struct ParticleKind {
  ParticleVolume volume = ParticleVolume::kBox;
  glm::vec3 half_extent_m{0.0F};  // of the box, 0 … 1000; kAroundCamera: at least 1 each

  float rate = 20;               // births a second, > 0
  float lifetime_s = 3;          // 0.01 … 1000
  float lifetime_variation = 0;  // 0 … 1: lives are shorter by up to this share

  glm::vec3 velocity{0, 1, 0};  // at birth, m/s
  float spread = 0.2F;          // random part of it, m/s along each axis
  float gravity = 0;            // m/s² downwards; negative: particles rise
  float drag = 0;               // 1/s: how fast velocities become that of the wind
  glm::vec3 wind{0.0F};         // m/s; only drag makes particles follow it
  float turbulence_m = 0;       // how far particles stray from their path

  float first_size_m = 0.5F, last_size_m = 0.5F;  // width at birth and at the end, 0 … 100
  float size_variation = 0;  // 0 … 1: particles are smaller by up to this share
  glm::vec4 first_colour{1.0F}, last_colour{1.0F, 1.0F, 1.0F, 0.0F};  // linear; a: opacity 0 … 1
  float brightness_variation = 0;         // 0 … 1: particles are darker by up to this share
  float fade_in = 0.1F, fade_out = 0.3F;  // shares of a life in which opacity comes and goes

  float glow = 0;      // 0: lit by sun, sky and point lights; 1: colours are light, before exposure
  float cover = 1;     // share of what is behind that is hidden; 0: light is added (fire)
  float softness = 1;  // of the disc's edge, 0 … 1
  float aspect = 1;    // width over height
  float streak_s = 0;  // > 0: a streak along the motion, as long as that in this many seconds
  float spin = 0;      // rad/s in the picture, either way
  float tumbling = 0;  // rad/s about their height: leaves turn over
  MaterialId material = kPlainMaterial;  // its base texture instead of a disc; rest is ignored
};

// An emitter of a frame, relative to the camera.
struct ParticleDraw {
  ParticleKind kind;
  glm::vec3 origin{0.0F};  // kAroundCamera: the camera in the lattice of boxes (box_place)
  std::array<glm::vec3, 3> axes{glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1)};
  float scale = 1;              // of sizes and speeds
  std::uint32_t count = 0;      // of particles, 1 … kMaxParticlesPerEmitter
  std::uint32_t seed = 0;       // of the generation of the first particle …
  std::uint32_t next_seed = 0;  // … and of the next one; both below 2^24
  float cycle_s = 1;            // from a birth of a particle to its next one, > 0
  float cycle = 0;              // share of it that has passed for the first particle, 0 … 1
  float youngest_s = 0, oldest_s = 1e9F;  // ages of particles that were born while it emitted
  float sun = 1;                          // share of the sun that no terrain hides
  float opacity = 1;                      // of all of them
};

// Returns true if all numbers of a kind are within their ranges.
bool is_valid(const ParticleKind& kind);
// The number of particles that live at a time: rate · lifetime, 1 … kMaxParticlesPerEmitter.
std::uint32_t particle_count(const ParticleKind& kind);
// A bound of the distance between where an emitter is and what it draws, in metres. `scale` as of
// ParticleDraw, `half_diagonal_m` of its turned box.
float reach_m(const ParticleKind& kind, float scale, float half_diagonal_m);

// A line between two points relative to the camera.
struct Line {
  glm::vec3 from{0.0F}, to{0.0F};
  glm::vec3 colour{1.0F};  // as on screen
};

// A soft dark spot on the ground: a disc seen from above, darkest in its middle. It is drawn up to
// kNearGroundM.
struct GroundSpot {
  glm::vec2 middle{0.0F};  // x and z, relative to the camera
  float radius_m = 0;      // of its end
  float sun = 0, sky = 0;  // shares of the light that are missing in the middle, 0 to 1
};

inline constexpr float kMorphByDistance = -1.0F;  // TerrainDraw::morph
inline constexpr std::size_t kMaxLines = 1 << 16;

// Morphing of terrain by the horizontal distance of each vertex.
struct Morph {
  float from_m = 0, to_m = 0;  // distances at which it begins, and at which heights are coarse
};

inline constexpr float kMinResolution = 0.25F;  // FrameInput::resolution

// Everything that a frame shows. Spans must stay valid during render(). The pose is
// core::is_valid(); the field of view is between 0.001 and 3.13 rad, aspect and near plane between
// 1e-6 and 1e6.
struct FrameInput {
  core::CameraPose pose;
  core::Projection projection;
  Light light;
  TerrainPalette palette;
  std::optional<WaterPlane> water;
  glm::vec3 water_colour{0.010F, 0.045F, 0.050F};  // linear albedo of deep rivers and lakes
  Canopy canopy;
  WorldEdge edge;
  View view = View::kNormal;
  // Share of the picture's width and height that the landscape has, kMinResolution … 1; it is
  // scaled up to the picture. Text over it always has all pixels.
  float resolution = 1;
  Morph morph;
  float fade_phase = 0;     // 0 to 1, of the pattern in which draws with `fade` share their pixels
  double block_size_m = 0;  // anchors the slow pattern of the ground; 0: no pattern
  std::span<const TerrainDraw> terrain;  // nearest first, committed ranges only
  std::span<const MeshDraw> models;      // nearest first, committed ranges only
  std::span<const ObjectDraw> objects;   // nearest first, committed ranges only
  // Rivers and lakes: meshes of core::WaterVertex. Only range, origin, box and sun count.
  std::span<const MeshDraw> water_surfaces;  // farthest first, committed ranges only
  std::span<const GroundSpot> spots;         // under what stands near the camera, in any order
  std::span<const PointLight> point_lights;  // the first kMaxPointLights are used
  // Back to front; drawn over everything else of the landscape. At most kMaxEmitters are drawn.
  std::span<const ParticleDraw> particles;
  std::span<const Line> lines;  // at most kMaxLines are drawn, in every view
  // Over the picture, in this order.
  const HudDrawing* hud = nullptr;  // of the game; null: none
  std::span<const TextPanel> panels;
  float text_scale = 1;             // of the panels' text, 1 … 4, rounded
  const ImDrawData* gui = nullptr;  // of an ImGui context on Renderer::font_atlas(); null: none
};

// The passes of a frame, in order.
inline constexpr std::array<std::string_view, 8> kPassNames{
    "shadows", "landscape", "sky", "water", "particles", "lines", "scale_up", "overlay"};

// The device's own time for a frame, from the start of its first pass to the end of its last one.
// On a software device it is time of this machine's processors, spread over its threads.
struct GpuTime {
  std::uint64_t frame = 0;  // FrameResult::frame
  double submitted_s = 0;   // time of submission, by core::monotonic_seconds()
  double ms = 0;
  double shadows_ms = 0;  // part of `ms` for the cascades of the sun's shadow
  // Parts of `ms`, from the end of the pass before to the end of each; 0 without
  // DeviceInfo::pass_times.
  std::array<double, kPassNames.size()> pass_ms{};
};

// Time during which the main thread was blocked.
struct Wait {
  double start_s = 0;  // core::monotonic_seconds()
  double ms = 0;
};

// Why a frame's time cannot be compared with that of others.
enum class Apart : std::uint8_t {
  kNo,
  kAfterIdle,  // the device was idle before, so there was no wait for an older frame
  kResized,    // the picture or the window's images were recreated
  kNotDrawn,   // the window takes no picture now
};

// The result of a frame.
struct FrameResult {
  std::uint64_t frame = 0;  // number of the frame, ascending; 0: none was submitted
  std::uint32_t draws = 0;  // on the GPU path: of the latest finished frame, 0 until there is one
  std::uint64_t triangles = 0;  // the same
  double cpu_ms = 0;            // recording and submission
  Wait device;                  // for the frame before the last
  Wait acquire;                 // for an image of the window
  Wait present;  // for presenting; software devices: the frame before, which is finished here
  std::optional<GpuTime> gpu;  // of the latest frame with a known time, usually four frames ago
  Apart apart = Apart::kNo;
  bool presented = false;  // windowed: shown; headless: drawn
  // Time by core::monotonic_seconds() at which the picture was given to the window; headless: to
  // the device. 0: it was not.
  double handed_over_s = 0;
  std::uint64_t memory_bytes = 0;  // of all device memory that the renderer has allocated
  // FrameInput::resolution, or 1 where the device or its memory cannot have less.
  double resolution = 1;

  // Sum of all waits.
  double wait_ms() const { return device.ms + acquire.ms + present.ms; }
};

// A mesh as it was submitted. Indices and vertices count from the start of their buffers.
struct DrawnMesh {
  core::VertexLayout layout = core::VertexLayout::kModel;
  std::uint32_t pool_block = 0;
  bool shared = false;  // indices from the shared lists, else from the pool block
  std::uint32_t first_index = 0, index_count = 0;
  std::int32_t vertex_offset = 0;
  glm::vec3 place{0.0F};  // relative to the camera; terrain: its corner; model: middle of its box
};

// A picture: rows from the top, 4 bytes per pixel (red, green, blue, alpha), as for a display.
struct Picture {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> rgba;
};

}  // namespace psygen::render
