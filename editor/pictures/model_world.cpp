#include "editor/pictures/model_world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "engine/synthesis/synthesise.hpp"
#include "engine/world/files/text_edit.hpp"
#include "engine/world/files/text_snippet.hpp"
#include "engine/world/files/toml_values.hpp"
#include "engine/world/placement.hpp"

namespace psygen::editor {
namespace {

// Blocks of four kilometres, so that the next model is a dot on the horizon.
constexpr std::string_view kStudio = R"(format = 1

[world]
name = "portrait"
seed = 7
blocks = [0, 0]
block_vertices = 64
cell_m = 64

[terrain]
octaves = 1
relief_m = 0.01

[sky]
sun_azimuth_deg = 222
sun_elevation_deg = 36
sun_colour = [3.3, 2.9, 2.4]
zenith_colour = [0.24, 0.36, 0.58]
horizon_colour = [0.62, 0.68, 0.76]
haze_colour = [0.62, 0.68, 0.76]
visibility_m = 2500
haze_height_m = 2000
cloud_cover = 0

[palette]
grass = [0.15, 0.155, 0.12]
forest = [0.15, 0.155, 0.12]
dry = [0.15, 0.155, 0.12]
dry_start_m = 1000
snow_start_m = 1000
sand_end_m = -1000
)";
// The valley of the README, for images of skies and terrains.
constexpr std::string_view kLandscape = R"(format = 1

[world]
name = "country"
seed = 71
blocks = [0, 0]
block_vertices = 64
cell_m = 1

[terrain]
octaves = 9
height = 1.15
lacunarity = 2.03
offset = 0.98
gain = 1.8
feature_m = 720
relief_m = 330

[[scatter]]
model = "tree"
count = 14
max_height_m = 150
max_slope_deg = 32

[palette]
dry_start_m = 150
dry_blend_m = 60
snow_start_m = 250
snow_blend_m = 18
)";
constexpr double kLandscapeReliefM = 330;
constexpr double kSnowyM = 300;  // lower terrains have no snow

constexpr int kTried = 4;            // blocks per side in the search for an isolated model
constexpr double kPitch = -0.09;     // slightly from above
constexpr double kMargin = 1.12;     // factor around the model
constexpr double kMinHeight = 0.25;  // of the camera above ground, in heights of the model

// The text with its only scatter without limits of the ground, and with one instance per block.
core::Result<std::string> alone(core::Result<std::string> text) {
  for (const char* limit :
       {"min_height_m", "max_height_m", "max_slope_deg", "on_ground", "mask_image", "mask_area_m",
        "mask_noise_m", "max_depth_m", "near_water_m", "spacing_m", "min_slope_deg",
        "facing_spread_deg", "max_above_water_m", "far_from_water_m", "near_road_m",
        "far_from_road_m", "beside", "beside_m", "edge_size"})
    if (text) text = world::without_value(*text, {"scatter", 0, limit});
  if (text) text = world::with_value(*text, {"scatter", 0, "count"}, "1");
  return text;
}

// The table `from` of a text appended to `to`.
core::Result<std::string> appended(core::Result<std::string> to, const char* array,
                                   const std::string& table) {
  if (!to) return to;
  return world::with_table_appended(*to, {array}, table);
}

// The table of an array with this name in quotes, if the text has one.
std::optional<std::string> table_named(std::string_view text, const char* array,
                                       const std::string& name_toml) {
  for (std::size_t i = 0; i < world::item_count(text, {array}); ++i) {
    if (world::value_text(text, {array, i, "name"}) == name_toml)
      return world::table_text(text, {array, i});
  }
  return std::nullopt;
}

double relief_of(std::string_view terrain) {
  double relief_m = kLandscapeReliefM;
  const auto value = world::value_text(terrain, {"terrain", "relief_m"});
  if (value) std::from_chars(value->data(), value->data() + value->size(), relief_m);
  return relief_m;
}

// The landscape with a terrain: the heights of trees, heath and snow scale with its height range.
core::Result<std::string> landscape_with(std::string_view terrain) {
  auto text = world::with_snippet(kLandscape, {"terrain"}, terrain);
  const double relief_m = relief_of(terrain);
  const std::pair<world::TextPath, double> heights[] = {
      {{"scatter", 0, "max_height_m"}, 0.45 * relief_m},
      {{"palette", "dry_start_m"}, 0.45 * relief_m},
      {{"palette", "dry_blend_m"}, std::max(0.2 * relief_m, 1.0)},
      {{"palette", "snow_start_m"}, relief_m >= kSnowyM ? 0.76 * relief_m : 1e6}};
  for (const auto& [path, height_m] : heights)
    if (text) text = world::with_value(*text, path, world::toml_number(height_m));
  return text;
}

std::optional<std::string> name_of_table(std::string_view snippet) {
  const auto table = world::snippet_table(snippet);
  if (!table || table->size() != 1) return std::nullopt;
  return table->back().key;
}

}  // namespace

std::optional<world::TextPath> subject_of(const world::TextPath& path) {
  if (path.size() < 2 || !path.steps[1].is_index) return std::nullopt;
  const std::string& table = path.steps[0].key;
  if (table != "species" && table != "scatter") return std::nullopt;
  return path.first(2);
}

core::Result<std::string> portrait_of(std::string_view text, const world::TextPath& subject) {
  const bool is_species = subject.steps[0].key == "species";
  const auto table = world::table_text(text, subject);
  const auto model = world::value_text(text, subject.with(is_species ? "name" : "model"));
  if (!table || (is_species && !model))
    return core::fail(core::ErrorCode::kInvalidArgument,
                      fmt::format("{}: there is no such table", subject.text()));
  core::Result<std::string> studio{std::string(kStudio)};
  if (is_species)
    return appended(appended(std::move(studio), "species", *table), "scatter",
                    fmt::format("model = {}\ncount = 1\n", *model));
  for (const char* array : {"species", "model"}) {
    if (const auto type = model ? table_named(text, array, *model) : std::nullopt)
      studio = appended(std::move(studio), array, *type);
  }
  return alone(appended(std::move(studio), "scatter", *table));
}

PicturePlace landscape_viewpoint(std::string_view snippet) {
  PicturePlace place{{-1257, 24, 3978}, 1.92, -0.1, true};
  if (name_of_table(snippet) != "terrain") return place;
  place.at_m.y = std::max(40.0, 0.3 * relief_of(snippet));
  place.pitch = -0.2;
  return place;
}

bool is_portrait(std::string_view snippet) {
  const auto table = name_of_table(snippet);
  return table == "species" || table == "scatter";
}

core::Result<std::string> snippet_world(std::string_view snippet) {
  const std::string table = name_of_table(snippet).value_or("");
  if (table == "species")
    return appended(std::string(kStudio), "species", std::string(snippet))
        .and_then([](const std::string& text) {
          return portrait_of(text, {"species", 0});
        });
  if (table == "scatter")
    return alone(appended(std::string(kStudio), "scatter", std::string(snippet)));
  if (table == "terrain") return landscape_with(snippet);
  if (table == "sky") return world::with_snippet(kLandscape, {table}, snippet);
  return core::fail(core::ErrorCode::kInvalidArgument,
                    fmt::format("presets of [{}] have no image", table));
}

std::optional<IsolatedModel> isolated_model(const world::World& world,
                                            const models::Registry& registry) {
  const double block_m = world.block_size_m();
  std::optional<IsolatedModel> found;
  double best_m = -1;
  std::vector<world::Placement> placements;
  for (int i = 0; i < kTried * kTried; ++i) {
    const core::BlockCoord block{i % kTried, i / kTried};
    world::place_models(world, registry, block, placements);
    if (placements.empty()) continue;
    const glm::dvec3 at(placements[0].position);
    const double space_m = std::min({at.x, at.z, block_m - at.x, block_m - at.z});
    if (space_m <= best_m) continue;
    best_m = space_m;
    found = IsolatedModel{{block, at}, placements[0].model, placements[0].parameters};
  }
  return found;
}

PortraitPose framing_pose(const core::WorldPosition& base, const core::Bounds& box, double block_m,
                          const core::Projection& projection, double distance_m) {
  const glm::dvec3 half(box.half_extent()), middle(box.centre());
  const double half_fov = static_cast<double>(projection.vertical_fov) / 2;
  const double up = std::tan(half_fov);
  const double across = up * static_cast<double>(projection.aspect);
  const double radius_m = std::hypot(half.x, half.z) * 0.85;  // crowns do not fill the corners
  if (distance_m <= 0)
    distance_m =
        std::max({kMargin * half.y / up, kMargin * radius_m / across, 0.2}) + radius_m * 0.7;
  core::CameraPose pose;
  pose.pitch = kPitch;
  pose.position = base;
  pose.position.local += middle - glm::dvec3(core::forward_of(pose)) * distance_m;
  pose.position.local.y =
      std::max(pose.position.local.y, base.local.y + std::max(kMinHeight * 2 * half.y, 0.05));
  // Looks at the middle.
  pose.pitch = std::atan2(base.local.y + middle.y - pose.position.local.y, distance_m);
  pose.position = core::normalised(pose.position, block_m);
  return {pose, {base.block, base.local + middle}, distance_m};
}

std::optional<PortraitPose> portrait_pose(const ParsedWorld& parsed,
                                          const core::Projection& projection, double distance_m) {
  const auto model = isolated_model(parsed.world, parsed.registry);
  if (!model) return std::nullopt;
  const models::ModelType& type = parsed.registry[model->model];
  core::Bounds box = type.bounds(model->parameters);
  const int level = std::min(1, type.level_count_of(model->parameters) - 1);
  if (const auto memory = synthesis::HeapDestination::make(type, model->parameters, level)) {
    const auto made = synthesis::synthesise_guarded(type, model->parameters, level, memory->view());
    if (made.ok) box = made.tight;
  }
  return framing_pose(model->base, box, parsed.world.block_size_m(), projection, distance_m);
}

}  // namespace psygen::editor
