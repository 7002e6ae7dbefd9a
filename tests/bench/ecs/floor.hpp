// The floor: one hand-written table with fixed columns and the guarantees of the library (8-byte
// handles with generations, no holes, stable addresses, stale handles dropped). It supports no
// other component types. Single-threaded.
#pragma once

#include <cstring>

#include "ecs/reserved_memory.hpp"
#include "tests/bench/ecs/components.hpp"

namespace psygen::ecs::bench {

// Room for 2 * kEntities values at an address that never changes.
template <class T>
class FloorColumn {
 public:
  // Commits the whole range.
  FloorColumn() : memory_(kEntities * 2 * sizeof(T)) { memory_.commit(kEntities * 2 * sizeof(T)); }
  // The value of a row, and the address of row 0.
  T& operator[](std::size_t row) { return data()[row]; }
  T* data() { return reinterpret_cast<T*>(memory_.data()); }

 private:
  detail::ReservedMemory memory_;
};

// Generation and row of the entity with the slot's index.
struct FloorSlot {
  std::uint32_t generation;
  std::uint32_t row;
};

// Columns, slots and free slots. Rows [0, rows) are filled.
struct FloorTable {
  FloorColumn<Entity> entities;
  FloorColumn<Position> positions;
  FloorColumn<Velocity> velocities;
  FloorColumn<Mass> masses;
  FloorColumn<Mesh> meshes;
  FloorColumn<FloorSlot> slots;
  std::vector<std::uint32_t> free;
  std::size_t rows = 0;
  std::uint32_t slot_count = 0;

  // Adds `count` rows with new handles and returns the first; the caller fills their columns.
  std::size_t create(std::size_t count) {
    const std::size_t first = rows;
    for (std::size_t i = 0; i < count; ++i, ++rows) {
      std::uint32_t index = 0;
      if (free.empty()) {
        index = slot_count++;
        slots[index].generation = 1;
      } else {
        index = free.back();
        free.pop_back();
      }
      slots[index].row = static_cast<std::uint32_t>(rows);
      entities[rows] = {index, slots[index].generation};
    }
    return first;
  }

  // Returns true if the handle is not stale.
  bool alive(Entity e) { return e.index < slot_count && slots[e.index].generation == e.generation; }

  // Removes these entities; the last row fills each hole. Stale handles are skipped.
  void destroy(std::span<const Entity> dying) {
    for (const Entity e : dying) {
      if (!alive(e)) continue;
      const std::uint32_t row = slots[e.index].row;
      const std::size_t last = --rows;
      positions[row] = positions[last];
      velocities[row] = velocities[last];
      masses[row] = masses[last];
      meshes[row] = meshes[last];
      entities[row] = entities[last];
      slots[entities[row].index].row = row;
      ++slots[e.index].generation;
      free.push_back(e.index);
    }
  }
};

}  // namespace psygen::ecs::bench
