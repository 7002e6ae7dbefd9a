// Creates entities with a component.
#include "ecs/ecs.hpp"

struct Height {
  float m = 0;
};

int main() {
  psygen::ecs::World world;
  const auto created = world.create<Height>(3);
  const psygen::ecs::Entity entity = created.entities[0];
  world.get<Height>(entity)->m = 2;
  return world.get<Height>(entity)->m == 2 ? 0 : 1;
}
