#include "engine/app/plugin_systems.hpp"

#include <fmt/format.h>

#include "ecs/ecs.hpp"
#include "engine/app/plugin_call.hpp"
#include "engine/app/session.hpp"
#include "engine/scene/frame/clock.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/systems.hpp"
#include "engine/telemetry/own_figures.hpp"

namespace psygen::app {
namespace {

// The times of systems and the game's figures are columns of one file.
core::Result<void> check_columns(scene::Scene& scene) {
  for (const std::string& system : scene.system_names())
    for (const telemetry::FigureInfo& figure : scene.figures().infos())
      if (system + "_ms" == "figures." + figure.name)
        return core::invalid_argument(
            fmt::format("the figure '{}' and the system '{}' have the same column of frames.csv",
                        figure.name, system));
  return {};
}

}  // namespace

core::Result<void> register_models(const std::vector<Plugin>& plugins, models::Registry& registry) {
  return call_plugins(plugins, &Plugin::register_models, "register_models", registry);
}

core::Result<models::Registry> make_registry(const std::vector<Plugin>& plugins) {
  models::Registry registry = models::make_standard_registry();
  if (auto ok = register_models(plugins, registry); !ok) return tl::unexpected(ok.error());
  return registry;
}

core::Result<void> PluginSystems::add(const std::vector<Plugin>& plugins, Session& session) {
  scene::Scene& scene = session.scene();
  scene::Systems systems = scene.systems();
  // Gives the systems without an owner to a plugin; empty: their names need none.
  const auto claim = [&](const std::string& owner) {
    for (const ecs::Schedule* schedule : {&systems.frame, &systems.step})
      for (const ecs::SystemInfo& system : schedule->systems())
        owners_.try_emplace(system.name, owner);
  };
  claim({});
  for (const Plugin& plugin : plugins) {
    if (plugin.add_systems) {
      auto ok = call_plugin(plugin, "add_systems", [&] { return plugin.add_systems(systems); });
      if (!ok) return ok;
      claim(plugin.name);
    }
    if (!plugin.on_step) continue;
    systems.step.add(plugin.name + " on_step",
                     [&session, &plugin](const scene::FixedStep& step, ecs::World&) {
                       plugin.on_step(session, step.step_s);
                     });
    claim({});
  }
  scene.figures().close();
  if (auto ok = scene.arrange(); !ok) return ok;
  return check_columns(scene);
}

core::Error PluginSystems::with_plugin(core::Error error, scene::Scene& scene) const {
  const scene::Systems systems = scene.systems();
  for (const std::string& system : {systems.step.threw(), systems.frame.threw()}) {
    const auto owner = owners_.find(system);
    if (owner == owners_.end() || owner->second.empty()) continue;
    error.message = fmt::format("plugin {}: {}", owner->second, error.message);
    break;
  }
  return error;
}

}  // namespace psygen::app
