#include "editor/view/world_before.hpp"

#include <algorithm>

namespace psygen::editor {

bool shows_world_before(const scene::State& state) {
  const std::uint32_t tick = state.clock.tick - 1;  // the last one
  bool found = false;
  const auto look = [&](std::span<const ecs::Entity>, std::span<const scene::Demand> demands) {
    found = found || std::ranges::any_of(demands, [tick](const scene::Demand& demand) {
              return demand.stale && demand.in_view_tick == tick &&
                     demand.drawn_level != scene::kNoLevel &&
                     demand.wanted_level != scene::kNoLevel;
            });
  };
  for (const scene::ChosenNode& node : state.view.chosen) {
    if (node.level != 0 || !node.in_view) continue;
    state.entities.each_of<const scene::Demand>(std::span(&node.entity, 1), look);
    state.entities.each_of<const scene::Demand>(state.entities.children(node.entity), look);
  }
  return found;
}

}  // namespace psygen::editor
