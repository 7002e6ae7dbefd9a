// Each CASE but 0 must not compile, for the reason that CMakeLists.txt expects in the message.
#include "tests/ecs/components.hpp"

using namespace psygen::ecs;
using namespace psygen::ecs::test;

struct Immovable {
  Immovable() = default;
  Immovable(Immovable&&) = delete;
};

struct Opaque {
  int* pointer = nullptr;
};
template <>
struct psygen::ecs::ComponentTraits<Opaque> {
  static constexpr std::string_view name = "opaque";
  static constexpr auto fields = std::tuple{field("pointer", &Opaque::pointer)};
};

void misuse(World& world, const World& read_only, Entity entity) {
  world.each<const Mesh, Position>([](std::span<const Entity>, auto meshes, auto positions) {
    positions[0].x = static_cast<float>(meshes[0].id);
  });
  read_only.each<const Mesh>([](auto, auto) {});
#if CASE == 1
  world.each<const Mesh>([](auto, auto meshes) { meshes[0].id = 1; });
#elif CASE == 2
  read_only.each<Mesh>([](auto, auto) {});
#elif CASE == 3
  read_only.get<Mesh>(entity)->id = 1;
#elif CASE == 4
  world.mark_changed<Position>(entity);
#elif CASE == 5
  world.each<const Mesh>(
      [](auto rows, auto, std::span<const Mesh>) { rows.template mark_changed<Mesh>(0, 1); });
#elif CASE == 6
  world.create<Mesh, Mesh>(1);
#elif CASE == 7
  world.create<Immovable>(1);
#elif CASE == 8
  world.accessor<const Mesh>().get(entity)->id = 1;
#elif CASE == 9
  world.create<Position>(1).column<Mesh>();
#elif CASE == 10
  world.create<Position, Selected>(1);
#elif CASE == 11
  world.add<Velocity, Selected>(std::span(&entity, 1));
#elif CASE == 12
  world.each<Position, Selected>([](auto, auto, auto) {});
#elif CASE == 13
  Schedule(world).add("s", [](Query<const Position> query) {
    query.each([](auto, auto positions) { positions[0].x = 1; });
  });
#elif CASE == 14
  Query<const Mesh>(world).land<Mesh>({});
#elif CASE == 15
  Query<const Mesh>(world).accessor<const Position>();
#elif CASE == 16
  Schedule(world).add("s", [](Position) {});
#elif CASE == 17
  describe<Opaque>();
#elif CASE == 18
  world.reader<Position>();
#elif CASE == 19
  read_only.accessor<Mesh>();
#endif
  (void)entity;
}
