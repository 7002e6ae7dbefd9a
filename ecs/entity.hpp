// The handle of an entity: 8 bytes, an index into the world's slots and the generation of that
// slot. Not an owner: a handle keeps nothing alive and may be copied anywhere. When the entity
// dies, its slot's generation advances, so a kept handle is recognised as stale in every build.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

namespace psygen::ecs {

// Index and generation together name one entity of one world; the pair is never reused. The default
// is kNullEntity.
struct Entity {
  std::uint32_t index = UINT32_MAX;
  std::uint32_t generation = 0;  // never 0 for an entity
  friend constexpr bool operator==(Entity, Entity) = default;
};
static_assert(sizeof(Entity) == 8);

// Differs from every entity that ever lived.
inline constexpr Entity kNullEntity{};

}  // namespace psygen::ecs

// Lets unordered containers use handles as keys.
template <>
struct std::hash<psygen::ecs::Entity> {
  // Mixes both halves of the handle. O(1).
  std::size_t operator()(psygen::ecs::Entity entity) const noexcept {
    const std::uint64_t key = (std::uint64_t{entity.generation} << 32) | entity.index;
    const std::uint64_t mixed = (key ^ (key >> 29)) * 0x9E3779B97F4A7C15ull;
    return static_cast<std::size_t>(mixed ^ (mixed >> 32));
  }
};
