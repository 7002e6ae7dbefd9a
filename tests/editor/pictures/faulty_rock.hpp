// A rock that ends its process when it has six subdivisions, like a faulty model of a program.
#pragma once

#include <cstdlib>
#include <memory>

#include "engine/app/options.hpp"
#include "tests/engine/scene/forwarding_type.hpp"

namespace psygen::editor::testing {

inline const models::ModelType& usual_rock() {
  static const models::Registry registry = models::make_standard_registry();
  return registry[static_cast<models::ModelIndex>(registry.find("rock"))];
}

class FaultyRock final : public scene::ForwardingType {
 public:
  FaultyRock() : ForwardingType("faulty_rock", usual_rock()) {}
  core::Bounds synthesise(const models::Parameters& p, int level,
                          const models::MeshView& out) const override {
    const int i = models::parameter_index(of(), "subdivisions");
    if (p.integer(static_cast<std::size_t>(i)) == 6) std::abort();
    return of().synthesise(p, level, out);
  }
};

inline core::Result<void> register_faulty_rock(models::Registry& registry) {
  const auto added = registry.add(std::make_unique<FaultyRock>());
  if (!added) return tl::unexpected(added.error());
  return {};
}

inline app::Plugin faulty_rock_plugin() {
  app::Plugin plugin{.name = "faulty rocks"};
  plugin.register_models = register_faulty_rock;
  return plugin;
}

}  // namespace psygen::editor::testing
