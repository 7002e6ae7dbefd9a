#include "tests/fuzz/reading.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/core/assert.hpp"
#include "engine/core/hash.hpp"
#include "engine/core/utf8.hpp"
#include "engine/frametest/frame_test.hpp"
#include "engine/gltf/animation.hpp"
#include "engine/gltf/read_file.hpp"
#include "engine/handmade/files.hpp"
#include "engine/input/bindings_file.hpp"
#include "engine/input/recording.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/world/camera_path.hpp"
#include "engine/world/edits/edit_bytes.hpp"
#include "engine/world/files/path_file.hpp"
#include "engine/world/files/text_edit.hpp"
#include "engine/world/files/text_snippet.hpp"
#include "engine/world/files/world_file.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/water.hpp"
#include "engine/world/world.hpp"

namespace psygen::fuzz {
namespace {

// `name`: the name in the error message. `names_files`: the message may name missing files.
void check_refusal(const core::Error& error, const std::string& name, bool names_files = false) {
  using enum core::ErrorCode;
  PSYGEN_CHECK(error.code == kParse || error.code == kInvalidArgument ||
                   error.code == kOverBudget || (names_files && error.code == kIo),
               "a text is refused for what it says");
  PSYGEN_CHECK(error.message.starts_with(name), "a refusal names what is refused");
  PSYGEN_CHECK(core::shown(error.message) == error.message, "a refusal can be printed");
  PSYGEN_CHECK(error.message.size() < name.size() + 2000, "a refusal can be read");
}

std::string_view characters(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

// Resolves every file that a world names to the example.
class ExampleBeside final : public world::ResourceLoader {
 public:
  ExampleBeside() { file_.write(example_gltf()); }
  world::ModelTypes read_models(std::span<const world::ModelFile> files) const override {
    std::vector<world::ModelFile> examples(files.begin(), files.end());
    for (world::ModelFile& example : examples)
      example.path = file_.path();
    return handmade::files().read_models(examples);
  }
  core::Result<std::shared_ptr<const world::GreyPicture>> read_grey(
      const std::filesystem::path&) const override {
    return std::make_shared<const world::GreyPicture>(
        world::GreyPicture{2, 2, {0, 20'000, 40'000, 65'535}, 7});
  }

 private:
  FileInMemory file_;
};

bool read_as_world(const std::filesystem::path& file) {
  static const ExampleBeside beside;
  static models::Registry registry = models::make_standard_registry();
  static const std::size_t before = registry.size();
  registry.shrink(before);  // removes the species of the previous text
  const auto world = world::load_world(file, registry, &beside);
  if (!world) {
    check_refusal(world.error(), file.string() + ":");
    PSYGEN_CHECK(registry.size() == before, "a refused world registers nothing");
    return false;
  }
  const auto again =
      world::parse_world(world::write_world(*world, registry), "again", registry, &beside);
  PSYGEN_CHECK(again.has_value(), "a world that was read can be written");
  PSYGEN_CHECK(*again == *world, "a world reads back as it was");
  PSYGEN_CHECK(world::shape_hash(*again) == world::shape_hash(*world),
               "shaped ground reads back as it was");
  if (world->shaped.layer) {
    const double relief_m = world->terrain.real(models::kTerrainReliefM);
    for (const world::Road& road : world->shaped.roads) {
      const core::WorldPosition at = core::normalised(
          {{0, 0}, {road.points_m[0].x, 0, road.points_m[0].y}}, world->block_size_m());
      const double height_m =
          models::ground_height_m(world->terrain, at.block, at.local.x, at.local.z);
      PSYGEN_CHECK(height_m >= 0 && height_m < relief_m * 1.0001 + 0.001,
                   "a road has a height of the world");
    }
    for (const world::River& river : world->shaped.rivers) {
      const core::WorldPosition at = core::normalised(
          {{0, 0}, {river.points_m[0].x, 0, river.points_m[0].y}}, world->block_size_m());
      const auto water = world::water_surface(*world, at);
      PSYGEN_CHECK(water && std::isfinite(water->surface_m) && glm::length(water->normal) > 0.99F,
                   "a river has a surface over its spring");
    }
  }
  return true;
}

// Checks that an edit of any text is rejected, or applied in the new text; removals too.
void edit_as_text(std::string_view text) {
  for (const world::TextPath& path : {world::TextPath{"sky", "exposure"},
                                      {"scatter", 0, "count"},
                                      {"species", 0, "foliage", "up"}}) {
    const auto edited = world::with_value(text, path, "0.5");
    if (!edited) {
      PSYGEN_CHECK(!edited.error().message.empty(), "a refused edit says why");
      continue;
    }
    PSYGEN_CHECK(world::value_text(*edited, path) == "0.5", "an edited text has the value");
    const auto removed = world::without_value(*edited, path);
    PSYGEN_CHECK(removed && !world::value_text(*removed, path), "a removed value is gone");
  }
  const std::size_t count = world::item_count(text, {"scatter"});
  const auto added = world::with_table_appended(text, {"scatter"}, "count = 1\n");
  PSYGEN_CHECK(!added || world::item_count(*added, {"scatter"}) == count + 1, "a table is added");
  const auto without = world::without_table(text, {"scatter", 0});
  PSYGEN_CHECK(!without || count == 0 || world::item_count(*without, {"scatter"}) < count,
               "a removed table is gone");
  (void)world::with_table_moved(text, {"scatter", 1}, 0);
  (void)world::with_snippet(text, {"sky"}, text);
}

bool read_as_path(const std::filesystem::path& file) {
  static const world::World world = [] {
    const models::Registry registry = models::make_standard_registry();
    return *world::parse_world(
        "format = 1\n[world]\nname = \"flat\"\nseed = 1\nblocks = [0, 0]\nblock_vertices = 4\n"
        "[terrain]\noctaves = 1\n",
        "flat", registry);
  }();
  const auto path = world::load_camera_path(file);
  if (!path) {
    check_refusal(path.error(), file.string() + ":");
    return false;
  }
  for (const double share : {0.0, 0.3, 1.0})
    PSYGEN_CHECK(core::is_valid(path->pose_at(share * path->duration_seconds(), world)),
                 "a path has valid poses");
  return true;
}

input::Actions make_actions() {
  using platform::Key;
  input::Actions actions;
  (void)actions.add("jump", {{Key::kSpace}, {platform::PadButton::kA}});
  (void)actions.add("move_x", {{Key::kD}, {input::PadAxisDirection::kLeftStickLeft, -1, 0.3F}});
  return actions;
}

bool read_as_bindings(const std::filesystem::path& file) {
  input::Actions actions = make_actions();
  const std::string before = input::bindings_text(actions);
  const auto read = input::load_bindings(file, actions);
  if (!read) {
    check_refusal(read.error(), file.string() + ":");
    PSYGEN_CHECK(input::bindings_text(actions) == before, "refused bindings change nothing");
    return false;
  }
  const std::string written = input::bindings_text(actions);
  input::Actions again = make_actions();
  PSYGEN_CHECK(input::apply_bindings(written, "again", again).has_value() &&
                   input::bindings_text(again) == written,
               "bindings read back as they were");
  return true;
}

bool read_as_frame_test(std::string_view text) {
  const auto test = frametest::parse_frame_test(text, "test");
  if (!test) {
    check_refusal(test.error(), "test:");
    return false;
  }
  PSYGEN_CHECK(!test->budgets.empty() && !test->name.empty(),
               "a frame test has budgets and a name");
  for (const frametest::Budget& budget : test->budgets) {
    const double* number = std::get_if<double>(&budget.limit);
    PSYGEN_CHECK(number == nullptr || std::isfinite(*number), "limits are finite");
  }
  return true;
}

bool is_recording(const core::Result<input::Recording>& read, const std::string& name) {
  if (!read) {
    check_refusal(read.error(), name + ":");
    return false;
  }
  const std::string written = read->bytes();
  const auto again = input::Recording::parse(written, "again");
  PSYGEN_CHECK(again && again->bytes() == written, "a recording reads back as it was");
  input::Actions actions = make_actions();
  auto replay = input::Replay::create(*read, actions, read->step_s());
  for (int step = 0; replay && step < 100 && replay->step(actions); ++step) {
    for (const input::ActionState& state : actions.states())
      PSYGEN_CHECK(std::isfinite(state.value), "a recording has finite values");
  }
  return true;
}

// Returns the text with the right hash at its end, which no fuzzer guesses.
std::string with_right_hash(std::string_view text) {
  constexpr std::size_t kHashBytes = sizeof(std::uint64_t);
  std::string hashed(text.substr(0, text.size() - std::min(text.size(), kHashBytes)));
  const std::uint64_t hash = core::hash_bytes(bytes_of(hashed));
  hashed.append(reinterpret_cast<const char*>(&hash), kHashBytes);
  return hashed;
}

bool read_as_recording(std::string_view text, const std::filesystem::path& file) {
  const bool whole = is_recording(input::Recording::load(file), file.string());
  return is_recording(input::Recording::parse(with_right_hash(text), "hashed"), "hashed") || whole;
}

bool read_as_gltf(const std::filesystem::path& file) {
  world::HandmadeModel how;
  how.name = "fuzzed", how.file = file.string();
  const world::ModelFile one{file, &how};
  if (const auto type = std::move(handmade::files().read_models({&one, 1}).front())) {
    const models::Parameters p = models::default_parameters(**type);
    PSYGEN_CHECK((*type)->mesh_size(p, 0).triangle_count() > 0, "a model has triangles");
    PSYGEN_CHECK(core::is_finite((*type)->bounds(p).max), "a model has an end");
  } else {
    check_refusal(type.error(), file.string() + ":", true);
  }
  const auto model = gltf::read_file(file);
  if (!model) {
    check_refusal(model.error(), file.string() + ":", true);
    return false;
  }
  for (const gltf::Mesh& mesh : model->meshes) {
    for (const gltf::Primitive& primitive : mesh.primitives)
      PSYGEN_CHECK(
          core::check(primitive.mesh).has_value() &&
              (primitive.material == gltf::kNone || primitive.material < model->materials.size()),
          "meshes are valid");
  }
  for (std::size_t i = 0; i < model->nodes.size(); ++i)
    PSYGEN_CHECK(model->nodes[i].parent == gltf::kNone || model->nodes[i].parent < i,
                 "parents come first");
  for (const gltf::Animation& animation : model->animations) {
    for (const gltf::Channel& channel : animation.channels) {
      PSYGEN_CHECK(channel.node < model->nodes.size(), "animations move nodes that there are");
      for (const float share : {0.0F, 0.3F, 1.0F}) {
        const glm::vec4 value = gltf::value_at(channel, share * animation.duration_s);
        PSYGEN_CHECK(std::isfinite(value.x + value.y + value.z + value.w),
                     "animations have finite values");
      }
    }
  }
  return true;
}

constexpr core::BlockCoord kEdited{2, 3};

struct EditedWorld {
  models::Registry registry = models::make_standard_registry();
  world::World world = *world::parse_world(
      "format = 1\n[world]\nname = \"edited\"\nseed = 1\nblocks = [9, 9]\n"
      "block_vertices = 8\n[terrain]\noctaves = 1\n[[scatter]]\nmodel = \"rock\"\ncount = 9\n",
      "edited", registry);
};

const EditedWorld& edited_world() {
  static const EditedWorld world;
  return world;
}

bool read_as_edits(std::string_view text) {
  const auto& [registry, unedited] = edited_world();
  world::Edits edits;
  const auto loaded = world::load_block(edits, unedited, registry, kEdited, bytes_of(text));
  if (!loaded) {
    check_refusal(loaded.error(), "the edits of block (2, 3)");
    PSYGEN_CHECK(edits.empty(), "refused edits change nothing");
    return false;
  }
  world::Edits again;
  const auto written = world::encode_block(edits, registry, kEdited);
  PSYGEN_CHECK((written.empty() && edits.empty()) ||
                   (world::load_block(again, unedited, registry, kEdited, written) &&
                    again.layer()->blocks.root()->hash == edits.layer()->blocks.root()->hash),
               "edits read back as they were");
  world::World edited = unedited;
  world::set_edits(edited, edits.layer());
  std::vector<world::Placement> models;
  world::place_models(edited, registry, kEdited, models);
  for (const world::Placement& model : models)
    PSYGEN_CHECK(std::isfinite(model.position.y), "an edited block has models at valid places");
  const double relief_m = edited.terrain.real(models::kTerrainReliefM);
  for (const double at_m : {0.0, 1.5, 6.9}) {
    const double height_m = models::ground_height_m(edited.terrain, kEdited, at_m, at_m);
    PSYGEN_CHECK(height_m >= 0 && height_m < relief_m + 0.001,
                 "edited ground has a height of the world");
  }
  return true;
}

}  // namespace

std::string example_bindings() {
  return input::bindings_text(make_actions());
}

std::string example_frame_test() {
  return "format = 1\nname = \"walk\"\n[flight]\nworld = \"paper\"\npath = \"walk27\"\n"
         "size = [640, 360]\nseconds = 4\nclock = \"virtual\"\nfixed_step = 30\n"
         "target_fps = 60\nbudget_mib = 64\n[at_most]\nframe_ms.p99 = 25\n"
         "missing.pixels_max_percent = 1.5\n[equal]\npicture.grade = \"good\"\n";
}

std::string example_recording() {
  const input::Actions actions = make_actions();
  input::Recording recording(actions, 1.0 / 60);
  for (int step = 0; step < 20; ++step) {
    std::vector<input::ActionState> states(actions.size());
    states[0] = {1, step % 5 < 2, step % 5 == 0, step % 5 == 2};
    states[1].value = static_cast<float>(step / 3) / 7.0F;
    PSYGEN_CHECK(recording.add(states).has_value(), "a short recording fits");
  }
  return recording.bytes();
}

std::string example_edits() {
  const auto& [registry, world] = edited_world();
  world::Edits edits;
  models::GroundEdit stamp;
  stamp.change = models::GroundChange::kStampAdd;
  stamp.centre = {kEdited, {1, 0, 1}};
  stamp.radius_m = 3;
  stamp.map = std::make_shared<models::Heightmap>(models::Heightmap{3, 2, {1, 2, 3, 4, 5, 6}});
  const bool made = edits.remove(world, {kEdited, 1}) &&
                    edits.move(world, registry, {kEdited, 4}, {kEdited, {6.5, 0, 2}}) &&
                    edits.raise(world, {kEdited, {2, 0, 3}}, 5, 2) &&
                    edits.flatten(world, {kEdited, {4, 0, 3}}, 2, 30) &&
                    edits.edit_ground(world, stamp);
  PSYGEN_CHECK(made, "a block can be edited");
  return std::string(characters(world::encode_block(edits, registry, kEdited)));
}

std::string example_world() {
  return R"(format = 1
[world]
name = "made"
seed = 5
blocks = [8, 4]
cell_m = 2
block_vertices = 33
[terrain]
octaves = 4
[[lake]]
points_m = [[200, 100], [280, 90], [260, 160]]
shore_m = 5
[[river]]
points_m = [[40, 60], [150, 80], [230, 120]]
width_m = [4, 5, 6]
depth_m = 0.8
[[model]]
name = "leaf"
file = "models/leaf.gltf"
size_m = 3
sink_m = 0.25
levels = 3
collider = "box"
[[scatter]]
model = "leaf"
count = 4
max_slope_deg = 30
scale = [0.5, 2]
turn_deg = [0, 360]
[[scatter]]
model = "rock"
count = 4
on_ground = ["grass", "rock"]
mask_image = "masks/rocks.png"
mask_area_m = [10, 20.5, 300, 200]
mask_noise_m = 40
mask_share = 0.3
mask_patches = 2
[[place]]
model = "rock"
at_m = [30.5, 40]
above_m = 1
subdivisions = 1
[[stamp]]
image = "hill.png"
centre_m = [100, 90.5]
size_m = 60
turn_deg = 20
base_m = 2
height_m = 30
border_m = 9
mode = "set"
[[road]]
points_m = [[10, 20], [150, 80.5], [300, 40]]
width_m = 7
border_m = 5
smoothing_m = 20
clear_m = 2
)";
}

std::string example_gltf() {
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"nodes": [{"name": "leaf", "mesh": 0, "rotation": [0, 0, 0, 1], "children": [1]},
 {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 2, 3, 4, 1]}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 5, "material": 0}]}],
"materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 1]},
 "emissiveFactor": [0, 0.5, 0], "alphaMode": "MASK", "alphaCutoff": 0.25}],
"animations": [{"channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}],
 "samplers": [{"input": 1, "output": 0, "interpolation": "STEP"}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
 {"bufferView": 0, "byteOffset": 36, "componentType": 5126, "count": 3, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48}],
"buffers": [{"byteLength": 48, "uri": "data:application/octet-stream;base64,)"
         "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAABA"
         "\"}]}\n";
}

FileInMemory::FileInMemory() : descriptor_(memfd_create("text", MFD_CLOEXEC)) {
  PSYGEN_CHECK(descriptor_ >= 0, "there is memory for a file");
}

FileInMemory::~FileInMemory() {
  close(descriptor_);
}

void FileInMemory::write(std::string_view text) {
  const bool written =
      ftruncate(descriptor_, 0) == 0 &&
      pwrite(descriptor_, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size());
  PSYGEN_CHECK(written, "a text fits in memory");
}

std::filesystem::path FileInMemory::path() const {
  return fmt::format("/proc/self/fd/{}", descriptor_);
}

int read_as_everything(std::string_view text, FileInMemory& file) {
  file.write(text);
  edit_as_text(text);
  return int{read_as_world(file.path())} + int{read_as_path(file.path())} +
         int{read_as_bindings(file.path())} + int{read_as_frame_test(text)} +
         int{read_as_recording(text, file.path())} + int{read_as_edits(text)} +
         int{read_as_gltf(file.path())};
}

}  // namespace psygen::fuzz
