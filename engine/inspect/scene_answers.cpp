#include "engine/inspect/scene_answers.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "ecs/ecs.hpp"
#include "engine/app/session.hpp"
#include "engine/core/clock.hpp"
#include "engine/handmade/files.hpp"
#include "engine/models/registry.hpp"
#include "engine/render/types.hpp"
#include "engine/scene/components.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/scene/frame/quality.hpp"
#include "engine/scene/objects/components.hpp"
#include "engine/scene/objects/effects.hpp"
#include "engine/scene/settings.hpp"
#include "engine/scene/statistics.hpp"
#include "engine/synthesis/mesh_supply.hpp"
#include "engine/world/files/text_file.hpp"
#include "engine/world/files/world_file.hpp"
#include "engine/world/world.hpp"

namespace psygen::inspect {
namespace {

constexpr std::size_t kMaxNodes = 20'000;

// Flags of a node, as listed in docs/inspect.md.
enum NodeFlag : unsigned { kInView = 1, kDrawn = 2, kStale = 4, kRequested = 8, kFailed = 16 };

std::string name_of(const scene::Scene& scene, models::ModelIndex model) {
  return model < scene.registry().size() ? std::string(scene.registry()[model].name()) : "?";
}

// [x, z, level, flags, drawn level or −1, layer, missing meshes or −1, deadline or null, µs]
Json node_json(const scene::Scene& scene, const scene::QuadtreeNode& node,
               const scene::Visibility& seen, const scene::MissingMeshes& lacking,
               const scene::MeshSource& source, const scene::MeshDemand& demand) {
  const bool drawn = demand.drawn_level != scene::kNoLevel;
  const bool requested = demand.requested_level != scene::kNoLevel;
  const unsigned flags = (seen.in_view != 0 ? kInView : 0U) | (drawn ? kDrawn : 0U) |
                         (demand.stale ? kStale : 0U) | (requested ? kRequested : 0U) |
                         (demand.failed_levels != 0 ? kFailed : 0U);
  const double cost_us =
      1e6 * scene.meshes().costs().predict(source.model, source.parameters, source.first_level);
  const std::int64_t lacks =
      lacking.meshes == UINT32_MAX ? -1 : static_cast<std::int64_t>(lacking.meshes);
  return Json::array({node.at.coord.x, node.at.coord.z, node.at.level, flags,
                      drawn ? int{demand.drawn_level} : -1, seen.layer, lacks,
                      double{seen.deadline_s}, std::round(cost_us)});
}

Json node_list(const scene::Scene& scene) {
  std::vector<std::pair<std::uint8_t, Json>> nodes;
  scene.entities()
      .each<const scene::QuadtreeNode, const scene::Visibility, const scene::MissingMeshes,
            const scene::MeshSource, const scene::MeshDemand>(
          [&](auto, auto at, auto seen, auto lacking, auto sources, auto demands) {
            for (std::size_t i = 0; i < at.size() && nodes.size() < kMaxNodes; ++i)
              nodes.emplace_back(at[i].at.level, node_json(scene, at[i], seen[i], lacking[i],
                                                           sources[i], demands[i]));
          });
  std::ranges::stable_sort(nodes, std::greater{}, [](const auto& node) { return node.first; });
  Json list = Json::array();
  for (auto& [level, node] : nodes)
    list.push_back(std::move(node));
  return list;
}

struct KindCount {
  std::uint64_t entities = 0, drawn = 0;
};

Json kind_counts(const scene::Scene& scene) {
  std::map<std::string, KindCount> kinds;
  scene.entities().each<const scene::MeshSource, const scene::MeshDemand>(
      [&](auto, auto sources, auto demands) {
        for (std::size_t i = 0; i < sources.size(); ++i) {
          KindCount& kind = kinds[name_of(scene, sources[i].model)];
          ++kind.entities;
          kind.drawn += demands[i].drawn_level != scene::kNoLevel ? 1 : 0;
        }
      });
  const auto add = [&](const char* name, std::uint64_t count, std::uint64_t drawn) {
    if (count > 0) kinds[name] = {count, drawn};
  };
  const scene::Statistics drawn = scene.statistics();
  add("objects", scene.entities().count<scene::Object>(), drawn.objects.drawn);
  add("lights", scene.entities().count<scene::PointLight>(), drawn.lights.lit);
  add("emitters", scene.entities().count<scene::ParticleEmitter>(), drawn.particles.emitters_drawn);
  Json list = Json::object();
  for (const auto& [name, kind] : kinds)
    list[name] = {{"entities", kind.entities}, {"drawn", kind.drawn}};
  return list;
}

Json cache_json(const scene::Scene& scene) {
  const synthesis::CacheStats stats = scene.meshes().stats();
  return {{"bytes", stats.bytes},
          {"budget_bytes", stats.budget_bytes},
          {"visible_bytes", stats.visible_bytes},
          {"meshes", stats.ready},
          {"hits", stats.hits},
          {"misses", stats.misses},
          {"evictions", stats.evictions}};
}

Json access_json(const ecs::SystemInfo& info, bool writes) {
  Json names = Json::array();
  for (const ecs::Access& access : info.accesses) {
    if (access.writes == writes) names.push_back(access.name);
  }
  return names;
}

}  // namespace

void FrameNotes::note(const scene::Scene& scene) {
  const double now_s = core::monotonic_seconds();
  ++frames;
  synthesis_s += scene.statistics().meshes.synthesis_seconds;
  if (last_frame_s > 0) {
    const double ms = (now_s - last_frame_s) * 1e3;
    ++figures;
    sum_ms += ms;
    longest_ms = std::max(longest_ms, ms);
  } else {
    figures_since_s = now_s;
  }
  last_frame_s = now_s;
  if (system_sum_ms.size() != scene.system_ms().size()) {
    system_sum_ms.assign(scene.system_ms().size(), 0);
    system_longest_ms.assign(scene.system_ms().size(), 0);
    timed = 0;
  }
  ++timed;
  for (std::size_t i = 0; i < system_sum_ms.size(); ++i) {
    system_sum_ms[i] += double{scene.system_ms()[i]};
    system_longest_ms[i] = std::max(system_longest_ms[i], double{scene.system_ms()[i]});
  }
}

Json figures(const app::Session& session, FrameNotes& notes) {
  const scene::Scene& scene = session.scene();
  const scene::Statistics statistics = scene.statistics();
  const double now_s = core::monotonic_seconds();
  const double modelers = std::max(1.0, static_cast<double>(scene.settings().modelers));
  const double passed_s = std::max(now_s - notes.figures_since_s, 1e-3);
  Json json = {
      {"frames", notes.frames},
      {"time_s", session.now_s()},
      {"paused", session.paused()},
      {"frame_ms", notes.figures > 0 ? notes.sum_ms / static_cast<double>(notes.figures) : 0.0},
      {"longest_ms", notes.longest_ms},
      {"triangles", scene.drawn().triangles},
      {"draws", scene.drawn().draws},
      {"nodes_in_view", statistics.drawn.nodes_in_view},
      {"holes", statistics.drawn.holes},
      {"coarse_nodes", statistics.drawn.coarse},
      {"missing_pixels_percent", statistics.drawn.missing_pixels_percent},
      {"error_pixels", scene.quality().error_pixels},
      {"resolution", scene.quality().resolution},
      {"queued", statistics.meshes.requests},
      {"outstanding", scene.meshes().outstanding()},
      {"modelers", modelers},
      {"busy_percent", std::min(100.0, 100 * notes.synthesis_s / (passed_s * modelers))},
      {"cache", cache_json(scene)},
      {"camera", pose_json(scene.camera().pose)}};
  notes.figures = 0;
  notes.sum_ms = notes.longest_ms = notes.synthesis_s = 0;
  notes.figures_since_s = now_s;
  return json;
}

Json systems(const scene::Scene& scene, FrameNotes& notes) {
  const std::vector<std::string> names = scene.system_names();
  const std::span<const ecs::SystemInfo> tick = scene.frame_systems();
  Json list = Json::array();
  const double frames = std::max(1.0, static_cast<double>(notes.timed));
  for (std::size_t i = 0; i < std::min(names.size(), notes.system_sum_ms.size()); ++i) {
    Json system = {{"name", names[i]},
                   {"mean_ms", notes.system_sum_ms[i] / frames},
                   {"longest_ms", notes.system_longest_ms[i]}};
    if (i < tick.size() && tick[i].name == names[i]) {
      system["reads"] = access_json(tick[i], false);
      system["writes"] = access_json(tick[i], true);
    }
    list.push_back(std::move(system));
  }
  notes.timed = 0;
  std::ranges::fill(notes.system_sum_ms, 0);
  std::ranges::fill(notes.system_longest_ms, 0);
  return {{"systems", std::move(list)}};
}

Json entities(const scene::Scene& scene) {
  const core::Projection& lens = scene.camera().projection;
  return {{"entities", scene.entities().size()},
          {"kinds", kind_counts(scene)},
          {"block_m", scene.world().block_size_m()},
          {"camera", pose_json(scene.camera().pose)},
          {"horizontal_fov",
           2 * std::atan(std::tan(double{lens.vertical_fov} / 2) * double{lens.aspect})},
          {"nodes", node_list(scene)}};
}

Json pose_json(const core::CameraPose& pose) {
  const core::WorldPosition& at = pose.position;
  return {{"block", {at.block.x, at.block.z}},
          {"local_m", {at.local.x, at.local.y, at.local.z}},
          {"yaw", pose.yaw},
          {"pitch", pose.pitch}};
}

core::Result<core::CameraPose> pose_from(const Json& json, double block_m) {
  const auto wrong = core::invalid_argument(
      "a pose has block [x, z] of at most 2147483647, local_m [x, y, z] of at most 1e12 m (y: 1e7 "
      "m), yaw and pitch of at most 1e9, up or down");
  const auto numbers = [&](const char* key, std::size_t count) {
    const auto found = json.find(key);
    return found != json.end() && found->is_array() && found->size() == count &&
           std::ranges::all_of(*found, [](const Json& value) { return value.is_number(); });
  };
  const auto number = [&](const char* key) { return json.contains(key) && json[key].is_number(); };
  if (!json.is_object() || !numbers("block", 2) || !numbers("local_m", 3) || !number("yaw") ||
      !number("pitch"))
    return wrong;
  core::CameraPose pose;
  for (int i = 0; i < 2; ++i) {
    const Json& block = json["block"][static_cast<std::size_t>(i)];
    if (!block.is_number_integer() || std::abs(block.get<double>()) > 2147483647.0) return wrong;
    (i == 0 ? pose.position.block.x : pose.position.block.z) = block.get<std::int32_t>();
  }
  pose.position.local = {json["local_m"][0].get<double>(), json["local_m"][1].get<double>(),
                         json["local_m"][2].get<double>()};
  pose.yaw = json["yaw"].get<double>();
  pose.pitch = json["pitch"].get<double>();
  if (!core::is_valid(pose)) return wrong;
  pose.position = core::normalised(pose.position, block_m);
  return pose;
}

std::string world_text(const app::Session& session) {
  const scene::WorldFacts& facts = session.scene().facts();
  std::string written = world::write_world(facts.world, facts.registry);
  const app::SessionOptions& options = session.options();
  std::string text;
  if (options.world_text) {
    text = *options.world_text;
  } else if (auto read = world::read_text_file(options.world_file)) {
    text = std::move(*read);
  }
  // The registry has the species if the world is the same.
  const models::Registry& types = facts.registry;
  auto world = world::parse_world(text, options.world_file.string(), types, &handmade::files());
  if (!world) return written;
  if (options.start_hour) world->sky.start_hour = *options.start_hour;
  return world::write_world(*world, types) == written ? text : written;
}

}  // namespace psygen::inspect
