#include "engine/inspect/scene_answers.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/app/session.hpp"
#include "engine/core/clock.hpp"
#include "engine/handmade/files.hpp"
#include "engine/scene/scene.hpp"
#include "engine/world/files/text_file.hpp"
#include "engine/world/files/world_file.hpp"

namespace psygen::inspect {
namespace {

constexpr std::size_t kMaxNodes = 20'000;

// Flags of a node, as listed in docs/inspect.md.
enum NodeFlag : unsigned { kInView = 1, kDrawn = 2, kStale = 4, kRequested = 8, kFailed = 16 };

std::string name_of(const scene::State& state, models::ModelIndex model) {
  return model < state.facts.registry.size() ? std::string(state.facts.registry[model].name())
                                             : "?";
}

// [x, z, level, flags, drawn level or −1, layer, missing meshes or −1, deadline or null, µs]
Json node_json(const scene::State& state, const scene::Node& node, const scene::Visibility& seen,
               const scene::Lacking& lacking, const scene::Source& source,
               const scene::Demand& demand) {
  const bool drawn = demand.drawn_level != scene::kNoLevel;
  const bool requested = demand.requested_level != scene::kNoLevel;
  const unsigned flags = (seen.in_view != 0 ? kInView : 0U) | (drawn ? kDrawn : 0U) |
                         (demand.stale ? kStale : 0U) | (requested ? kRequested : 0U) |
                         (demand.failed_levels != 0 ? kFailed : 0U);
  const double cost_us =
      1e6 * state.meshes.costs().predict(source.model, source.parameters, source.first_level);
  const std::int64_t lacks =
      lacking.meshes == UINT32_MAX ? -1 : static_cast<std::int64_t>(lacking.meshes);
  return Json::array({node.at.coord.x, node.at.coord.z, node.at.level, flags,
                      drawn ? int{demand.drawn_level} : -1, seen.layer, lacks,
                      double{seen.deadline_s}, std::round(cost_us)});
}

Json node_list(const scene::State& state) {
  std::vector<std::pair<std::uint8_t, Json>> nodes;
  state.entities.each<const scene::Node, const scene::Visibility, const scene::Lacking,
                      const scene::Source, const scene::Demand>(
      [&](std::span<const ecs::Entity>, std::span<const scene::Node> at,
          std::span<const scene::Visibility> seen, std::span<const scene::Lacking> lacking,
          std::span<const scene::Source> sources, std::span<const scene::Demand> demands) {
        for (std::size_t i = 0; i < at.size() && nodes.size() < kMaxNodes; ++i)
          nodes.emplace_back(at[i].at.level,
                             node_json(state, at[i], seen[i], lacking[i], sources[i], demands[i]));
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

Json kind_counts(const scene::State& state) {
  std::map<std::string, KindCount> kinds;
  state.entities.each<const scene::Source, const scene::Demand>(
      [&](std::span<const ecs::Entity>, std::span<const scene::Source> sources,
          std::span<const scene::Demand> demands) {
        for (std::size_t i = 0; i < sources.size(); ++i) {
          KindCount& kind = kinds[name_of(state, sources[i].model)];
          ++kind.entities;
          kind.drawn += demands[i].drawn_level != scene::kNoLevel ? 1 : 0;
        }
      });
  const auto add = [&](const char* name, std::uint64_t count, std::uint64_t drawn) {
    if (count > 0) kinds[name] = {count, drawn};
  };
  add("objects", state.entities.count<scene::Object>(), state.counters.objects_drawn);
  add("lights", state.entities.count<scene::PointLight>(), state.counters.lights_lit);
  add("emitters", state.entities.count<scene::ParticleEmitter>(), state.counters.emitters_drawn);
  Json list = Json::object();
  for (const auto& [name, kind] : kinds)
    list[name] = {{"entities", kind.entities}, {"drawn", kind.drawn}};
  return list;
}

Json cache_json(const scene::State& state) {
  const synthesis::CacheStats stats = state.meshes.stats();
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

void FrameNotes::note(const scene::State& state) {
  const double now_s = core::monotonic_seconds();
  ++frames;
  synthesis_s += state.counters.synthesis_seconds;
  if (last_frame_s > 0) {
    const double ms = (now_s - last_frame_s) * 1e3;
    ++figures;
    sum_ms += ms;
    longest_ms = std::max(longest_ms, ms);
  } else {
    figures_since_s = now_s;
  }
  last_frame_s = now_s;
  if (system_sum_ms.size() != state.system_ms.size()) {
    system_sum_ms.assign(state.system_ms.size(), 0);
    system_longest_ms.assign(state.system_ms.size(), 0);
    timed = 0;
  }
  ++timed;
  for (std::size_t i = 0; i < system_sum_ms.size(); ++i) {
    system_sum_ms[i] += double{state.system_ms[i]};
    system_longest_ms[i] = std::max(system_longest_ms[i], double{state.system_ms[i]});
  }
}

Json figures(const app::Session& session, FrameNotes& notes) {
  const scene::State& state = session.scene().state();
  const scene::Counters& counters = state.counters;
  const double now_s = core::monotonic_seconds();
  const double modelers = std::max(1.0, static_cast<double>(state.settings.modelers));
  const double passed_s = std::max(now_s - notes.figures_since_s, 1e-3);
  Json json = {
      {"frames", notes.frames},
      {"time_s", session.now_s()},
      {"paused", session.paused()},
      {"frame_ms", notes.figures > 0 ? notes.sum_ms / static_cast<double>(notes.figures) : 0.0},
      {"longest_ms", notes.longest_ms},
      {"triangles", counters.frame.triangles},
      {"draws", counters.frame.draws},
      {"nodes_in_view", counters.nodes_in_view},
      {"holes", counters.holes},
      {"coarse_nodes", counters.coarse},
      {"missing_pixels_percent", counters.missing_pixels_percent},
      {"error_pixels", state.quality.error_pixels},
      {"resolution", state.quality.resolution},
      {"queued", counters.requests},
      {"outstanding", state.meshes.outstanding()},
      {"modelers", modelers},
      {"busy_percent", std::min(100.0, 100 * notes.synthesis_s / (passed_s * modelers))},
      {"cache", cache_json(state)},
      {"camera", pose_json(state.camera.pose)}};
  notes.figures = 0;
  notes.sum_ms = notes.longest_ms = notes.synthesis_s = 0;
  notes.figures_since_s = now_s;
  return json;
}

Json systems(const scene::State& state, FrameNotes& notes) {
  const std::vector<std::string> names = scene::system_names(state);
  const std::span<const ecs::SystemInfo> tick = state.tick.systems();
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

Json entities(const scene::State& state) {
  const core::Projection& lens = state.camera.projection;
  return {{"entities", state.entities.size()},
          {"kinds", kind_counts(state)},
          {"block_m", state.facts.world.block_size_m()},
          {"camera", pose_json(state.camera.pose)},
          {"horizontal_fov",
           2 * std::atan(std::tan(double{lens.vertical_fov} / 2) * double{lens.aspect})},
          {"nodes", node_list(state)}};
}

Json pose_json(const core::CameraPose& pose) {
  const core::WorldPosition& at = pose.position;
  return {{"block", {at.block.x, at.block.z}},
          {"local_m", {at.local.x, at.local.y, at.local.z}},
          {"yaw", pose.yaw},
          {"pitch", pose.pitch}};
}

core::Result<core::CameraPose> pose_from(const Json& json, double block_m) {
  const auto wrong = core::fail(core::ErrorCode::kInvalidArgument,
                                "a pose has block [x, z], local_m [x, y, z], yaw and pitch, all "
                                "finite numbers");
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
  const scene::WorldFacts& facts = session.scene().state().facts;
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
