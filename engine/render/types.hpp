// What the renderer is told: options, light, palette, draws; and what it answers. Plain values
// without any Vulkan type. Metres, seconds, linear colours; positions relative to the camera.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/camera.hpp"
#include "engine/core/geometry_memory.hpp"
#include "engine/core/surface_provider.hpp"
#include "engine/render/text_panel.hpp"

namespace psygen::render {

// How meshes reach the device: many per call with their data in a buffer (kMultiDraw), or one per
// call with its data pushed (kPushed: a dearer draw, cheaper vertices on software devices). kAuto:
// multi-draw on hardware; on software devices by the size of each mesh.
enum class Submission : std::uint8_t { kAuto, kMultiDraw, kPushed };

// Who tests what is in view and chooses levels of detail: the CPU, or the device, which then also
// leaves out what is hidden (gpu_culling.hpp). kAuto: the device, unless it is software.
enum class RenderPath : std::uint8_t { kAuto, kCpu, kGpu };

// How meshes come into the device's memory: written there by the CPU, or into memory of its own and
// copied. kAuto: written, where the device has enough memory that the CPU can write.
enum class Upload : std::uint8_t { kAuto, kDirect, kStaged };

// How much light and detail a picture has; what each changes is in preset.hpp and docs/presets.md.
enum class Preset : std::uint8_t { kLow, kMedium, kHigh, kUltra };

// What a picture shows: the landscape, or something about how it is made.
enum class View : std::uint8_t {
  kNormal,
  kLevels,     // each draw in its `debug_colour`, which stands for its level
  kLayers,     // the same, for layers of visibility
  kBounds,     // the landscape with the frame's lines
  kWireframe,  // edges of triangles; the landscape where the device cannot
  kMissing,    // each draw in its `debug_colour`, which says how far it is from what is wanted
  kCache,      // the same, for what it takes of the geometry cache
};

// Told how far something long has come, as a fraction in [0, 1]; false gives it up. May be empty.
using Progress = std::function<bool(double)>;

class Renderer;

struct RendererOptions {
  std::string application_name = "psygen";
  std::string device_name;  // part of the device's name; empty: the best there is
  bool validation = false;  // Khronos layer with synchronization validation; messages are collected
  core::Extent size{1280, 720};  // of the picture; with a surface the framebuffer's size counts
  std::uint64_t geometry_budget_bytes = 512ull << 20;  // hard limit of geometry()
  core::SurfaceProvider* surface = nullptr;  // null: headless; else it outlives the renderer
  bool vsync = false;
  Submission submission = Submission::kAuto;  // kMultiDraw without VK_EXT_multi_draw is kPushed
  RenderPath path = RenderPath::kAuto;
  Upload upload = Upload::kAuto;
  bool occlusion = true;  // on the GPU path: leave out what was hidden in the last frame and is
  std::optional<Preset> preset;  // none: kLow on software devices, kHigh on others
  // Called while the pipelines are made, which takes seconds where the driver has not kept them
  // from before. Of the renderer only show() may be called; false: create() fails (kInterrupted).
  std::function<bool(Renderer&, double)> progress;
  double device_timeout_seconds = 60;  // longest wait for the device; then it counts as lost
  bool timestamps = true;              // FrameResult::gpu, where the device can
};

struct DeviceInfo {
  std::string name;         // "llvmpipe (LLVM 15.0.6, 256 bits)"
  std::string driver;       // name and version
  std::string api_version;  // "1.3.230"
  bool software = false;
  bool multi_draw = false;  // many meshes in one call
  bool gpu_path = false;    // RenderPath::kGpu can be used
  bool wireframe = false;   // View::kWireframe can be drawn
  bool timestamps = false;  // FrameResult::gpu is known
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
  float haze_density = 0.0012F;            // at height 0, 1/m; 1/density is where 37 % is left
  glm::vec3 haze_tint{0.82F, 1.0F, 1.3F};  // how much more of blue than of red the air takes
  float haze_height_falloff = 0.004F;      // 1/m; 0: the same at every height
  float exposure = 1.0F;
  float time_seconds = 0.0F;  // for wind and clouds
  float cloud_cover = 0.5F;   // 0 clear … 1 overcast
};

// A plane of water to the horizon.
struct Water {
  float level_m = 0.0F;                      // height in the world
  glm::vec3 colour{0.010F, 0.045F, 0.050F};  // linear albedo of deep water
};

// What hides the ground where `TerrainDraw::cover` says so: forests too far to be drawn.
struct Canopy {
  glm::vec3 colour{0.022F, 0.040F, 0.012F};  // linear albedo, from above
  float lowest_m = -1e6F, highest_m = 1e6F;  // where it can stand
  float blend_m = 20.0F;
  float slope_max = 0.30F;  // 1 − normal.y
};

// The rectangle that the world covers, relative to the camera; terrain beyond is moved onto it.
struct WorldEdge {
  glm::vec2 least{-1e30F}, greatest{1e30F};
};

// Linear albedo of the ground and where each kind of ground is. Heights in metres of the world.
// Slope is 1 − normal.y: 0 flat, 0.29 at 45°, 1 vertical.
struct TerrainPalette {
  glm::vec3 grass{0.085F, 0.125F, 0.030F};
  glm::vec3 forest{0.045F, 0.070F, 0.022F};
  glm::vec3 dry{0.200F, 0.165F, 0.075F};
  glm::vec3 rock{0.150F, 0.138F, 0.125F};
  glm::vec3 snow{0.74F, 0.78F, 0.84F};
  glm::vec3 sand{0.36F, 0.30F, 0.19F};
  float sand_end_m = -1e6F, sand_blend_m = 2.0F;    // sand below
  float dry_start_m = 60.0F, dry_blend_m = 40.0F;   // dry meadow above
  float snow_start_m = 1e6F, snow_blend_m = 15.0F;  // snow above, except where steep
  float rock_slope_start = 0.16F, rock_slope_full = 0.34F;
  float snow_slope_max = 0.40F;  // steeper ground sheds its snow
};

// Name of "no shared list": the mesh has indices of its own.
inline constexpr std::uint32_t kNoSharedIndices = 0;

// A coarser mesh for the same place and box.
struct DrawLevel {
  core::GeometryRange range;
  std::uint32_t shared_indices = kNoSharedIndices;
  float error_m = 0.0F;  // how far it is off; grows from level to level
};

// How far the wind moves a vertex of a mesh at most, either way, metres (shaders/model.vert).
inline constexpr glm::vec3 kSwayM{0.12F, 0.0F, 0.09F};

// A tree, rock or any other mesh of core::VertexLayout::kModel. With `fade` in (0, 1) it covers
// such a share of its pixels; with −fade, in (−1, 0], just the others: for what goes while it
// comes.
struct MeshDraw {
  core::GeometryRange range;
  std::uint32_t shared_indices = kNoSharedIndices;  // from upload_shared_indices
  glm::vec3 origin{0.0F};                           // the mesh's foot
  glm::vec3 box_center{0.0F};                       // box of the snorm16 positions, from the foot
  glm::vec3 box_half_extent{1.0F};
  core::IndexPart part;  // of its indices; of 0: all; not with `coarser`
  float fade = 1.0F;     // what is there of one that comes or goes
  float sun = 1.0F;      // share of the sun's light that the ground does not hold up, 0 to 1
  std::uint32_t debug_colour = 0x808080;    // 0xRRGGBB, in the views that colour draws
  std::span<const DrawLevel> coarser = {};  // read where FrameInput::choose
};

// A grid of core::VertexLayout::kTerrain.
struct TerrainDraw {
  core::GeometryRange range;
  std::uint32_t shared_indices = kNoSharedIndices;
  glm::vec3 origin{0.0F};                            // the block's corner at world height 0
  float cell_m = 1.0F;                               // between two grid lines
  float height_min_m = 0.0F, height_range_m = 1.0F;  // what unorm16 heights span
  float skirt_m = 0.0F;                              // how far skirt vertices hang down
  float morph = 0.0F;    // 0 fine heights … 1 coarse heights; kMorphByDistance: FrameInput::morph
  core::IndexPart part;  // of the shared list; of 0 indices: all of it
  float side_m = 0.0F;   // of the square that the grid covers; 0: as large as a grid can be
  std::span<const DrawLevel> coarser = {};  // read where FrameInput::choose
  float cover = 0.0F;                       // share of the ground that far forests hide (Canopy)
  std::uint32_t debug_colour = 0x808080;    // 0xRRGGBB, in the views that colour draws
};

// A line between two places relative to the camera.
struct Line {
  glm::vec3 from{0.0F}, to{0.0F};
  glm::vec3 colour{1.0F};  // as shown
};

inline constexpr float kMorphByDistance = -1.0F;
inline constexpr std::size_t kMaxLines = 1 << 16;

// Ground whose morph follows from the distance of each vertex, seen from above.
struct Morph {
  float from_m = 0, to_m = 0;  // where it begins, and where it has the coarse heights
};

struct FrameInput {
  core::CameraPose pose;
  core::Projection projection;
  Light light;
  TerrainPalette palette;
  std::optional<Water> water;
  Canopy canopy;
  WorldEdge edge;
  View view = View::kNormal;
  Morph morph;
  double block_size_m = 0;               // anchors the slow pattern of the ground; 0: no pattern
  std::span<const TerrainDraw> terrain;  // nearest first, committed ranges only
  std::span<const MeshDraw> models;      // nearest first, committed ranges only
  // The lists hold what lies outside the picture too, with `coarser` levels: the renderer chooses,
  // on either path, the coarsest level that is at most so many pixels off.
  bool choose = false;
  float max_error_pixels = 1.0F;
  std::span<const Line> lines;        // at most kMaxLines are drawn, in every view
  std::span<const TextPanel> panels;  // over the picture
  float text_scale = 1;               // of their text, 1 to 4, rounded
};

// What the device itself took for a frame, from its first pass to the end of its last one. On a
// software device it is processor time of this machine, spread over its threads.
struct GpuTime {
  std::uint64_t frame = 0;  // FrameResult::frame
  double submitted_s = 0;   // when, by core::monotonic_seconds()
  double ms = 0;
  double shadows_ms = 0;  // of these, for cascades of the sun's shadow
};

// Time in which the main thread could do nothing.
struct Wait {
  double start_s = 0;  // core::monotonic_seconds()
  double ms = 0;
};

// What sets a frame apart from others, so that its time says nothing of theirs.
enum class Apart : std::uint8_t {
  kNo,
  kAfterIdle,  // the device had been waited for and had nothing to do: no wait for an older frame
  kResized,    // the picture or the window's images were made anew
  kNotDrawn,   // the window takes no picture now
};

struct FrameResult {
  std::uint64_t frame = 0;  // numbers frames, ascending; 0: none was submitted
  std::uint32_t draws = 0;  // on the GPU path of the latest finished frame, 0 until there is one
  std::uint64_t triangles = 0;  // the same
  double cpu_ms = 0;            // recording and submission
  Wait device;                  // for the frame before the last
  Wait acquire;                 // for an image of the window
  Wait present;                 // handing it over; software devices finish the frame here
  std::optional<GpuTime> gpu;   // of the latest frame that is known, as a rule four frames ago
  Apart apart = Apart::kNo;
  bool presented = false;  // windowed: shown; headless: drawn

  double wait_ms() const { return device.ms + acquire.ms + present.ms; }
};

// A mesh as it was submitted.
struct DrawnMesh {
  core::VertexLayout layout = core::VertexLayout::kModel;
  std::uint32_t pool_block = 0;
  bool shared = false;  // indices from the shared lists, else from the pool block
  std::uint32_t first_index = 0, index_count = 0;
  std::int32_t vertex_offset = 0;
  glm::vec3 place{0.0F};  // terrain: its corner; model: the middle of its box
};

// Rows from the top, 4 bytes a pixel (red, green, blue, alpha) as shown on a display.
struct Picture {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> rgba;
};

}  // namespace psygen::render
