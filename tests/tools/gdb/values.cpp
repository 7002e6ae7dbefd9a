// Values of the types that tools/gdb/psygen.py prints, for gdb_test.py.
#include <array>
#include <span>

#include "ecs/ecs.hpp"
#include "engine/core/coordinates.hpp"
#include "engine/core/error.hpp"
#include "engine/synthesis/mesh_key.hpp"

namespace {

using namespace psygen;

struct Speed {
  float metres_per_second = 0;
};

// gdb stops here.
template <class... Values>
[[gnu::noinline]] void stop(const Values&... values) {
  const std::array<const void*, sizeof...(Values)> seen{&values...};
  asm volatile("" : : "r"(seen.data()) : "memory");
}

}  // namespace

int main() {
  ecs::World world;
  world.create<Speed>(2);
  const ecs::Entity nothing = ecs::kNullEntity;
  const core::WorldPosition position{{3, -4}, {1.5, 2, 0.25}};
  const synthesis::MeshKey key{
      .block = {-7, 8}, .index = 5, .model = 2, .level = 1, .parameters_hash = 0xAB};
  const synthesis::MeshKey duplicate = synthesis::duplicate_of(key);
  const core::Result<int> found = 42;
  const core::Result<int> lost = core::fail(core::ErrorCode::kIo, "a.toml: cannot be read");
  const core::Result<void> done;
  const std::array numbers{1, 2, 3};
  const std::span<const int> some(numbers.data(), 2);
  const std::span<const int, 3> three(numbers);
  world.each<Speed>(
      [&](ecs::TableRows<Speed> rows, std::span<const ecs::Entity> handles, std::span<Speed>) {
        stop(rows, handles, nothing, position, key, duplicate, found, lost, done, some, three);
      });
  return 0;
}
