#include "ecs/world.hpp"

#include <vector>

namespace psygen::ecs {

std::size_t World::destroy_with_children(std::span<const Entity> parents) {
  std::size_t died = 0;
  std::vector<Entity> generation(parents.begin(), parents.end());
  while (!generation.empty()) {
    std::vector<Entity> next;
    for (const Entity parent : generation) {
      const std::span<const Entity> list = children(parent);
      next.insert(next.end(), list.begin(), list.end());
    }
    died += destroy(generation);
    generation = std::move(next);
  }
  return died;
}

bool World::set_children(Entity parent, std::span<const Entity> children) {
  Children* list = storage_.children_of(parent);
  if (list == nullptr) return false;
  // The new children may be a list of this world, which may move when one grows.
  const std::vector<Entity> copy(children.begin(), children.end());
  storage_.set_children(*list, copy);
  return true;
}

}  // namespace psygen::ecs
