// The model types and systems that plugins add, and the plugin that each system belongs to. Not
// part of the public interface. Main thread only.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/app/options.hpp"

namespace psygen::scene {
class Scene;
}

namespace psygen::app {

// The standard registry with the types of the plugins. Fails like register_models().
core::Result<models::Registry> make_registry(const std::vector<Plugin>& plugins);

class PluginSystems {
 public:
  // Adds the systems of all plugins to the session's scene, in order, and arranges them. Hooks of a
  // step are systems: they run however the session is driven, and their cost is measured. Fails
  // like the plugins and Scene::arrange(), and if a system and a figure have one column.
  core::Result<void> add(const std::vector<Plugin>& plugins, Session& session);

  // Names the plugin whose system threw in the last tick, if one did.
  core::Error with_plugin(core::Error error, scene::Scene& scene) const;

 private:
  std::map<std::string, std::string> owners_;  // plugins by system; empty: the engine
};

}  // namespace psygen::app
