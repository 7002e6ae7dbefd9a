#include "ecs/world.hpp"

#include <vector>

namespace psygen::ecs {

std::size_t World::destroy_with_children(std::span<const Entity> parents) {
  storage_.expect_no_iteration("destroy_with_children");
  std::size_t died = 0;
  std::vector<Entity> level(parents.begin(), parents.end());
  while (!level.empty()) {
    std::vector<Entity> next;
    for (const Entity parent : level) {
      Children* list = storage_.children_of(parent);
      if (list == nullptr) continue;
      const std::span<const Entity> found = children(*list);
      next.insert(next.end(), found.begin(), found.end());
      storage_.set_children(*list, {});  // a parent visited again has no children left
    }
    died += destroy(level);
    level = std::move(next);
  }
  return died;
}

bool World::set_children(Entity parent, std::span<const Entity> children) {
  Children* list = storage_.children_of(parent);
  if (list == nullptr) return false;
  // The new children may be a list of this world, which may move when a list grows.
  const std::vector<Entity> copy(children.begin(), children.end());
  storage_.set_children(*list, copy);
  return true;
}

}  // namespace psygen::ecs
