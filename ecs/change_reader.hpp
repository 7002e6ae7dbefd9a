// One consumer of the changes of a tracked component. Every reader has its own bits: rows that one
// reader has drained are still new to another. A row counts as changed when it was created,
// written, added or marked. To a new reader all rows are new. Not an event queue: repeated changes
// of a row are one. Belongs to the world's thread and must not outlive its world.
#pragma once

#include <cstddef>
#include <span>
#include <utility>

#include "ecs/query.hpp"
#include "ecs/storage.hpp"

namespace psygen::ecs {

// Selects readers that also collect the entities that lost the component. Such a reader must drain
// them.
enum class Removed : bool { kIgnore, kReport };

// Made by World::reader. `Tag` separates readers of the same component by type, as a schedule
// needs.
template <Component C, class Tag = void>
class ChangeReader {
  static_assert(is_tracked<C>(),
                "only a tracked component has changes: ComponentTraits<C>::tracked");

 public:
  // Movable. A moved-from reader may only be assigned to or destroyed.
  ChangeReader(ChangeReader&& other) noexcept
      : storage_(std::exchange(other.storage_, nullptr)), state_(other.state_) {}
  ChangeReader& operator=(ChangeReader&& other) noexcept {
    std::swap(storage_, other.storage_);
    std::swap(state_, other.state_);
    return *this;
  }
  // Frees the reader's bits.
  ~ChangeReader() {
    if (storage_ != nullptr) storage_->remove_reader(*state_);
  }

  // Calls f(std::span<const Entity>, std::span<const C>) once per run of neighbouring rows that
  // changed since the last drain; visits exactly these rows and returns their number. `f` may mark
  // rows and write values, but not create, destroy, add or remove. O(tables + changed rows), plus
  // one word per 4096 rows.
  template <class F>
  std::size_t drain(F&& f) {
    const detail::IterationGuard guard(storage_->iteration(), detail::kQuery<const C>);
    std::size_t visited = 0;
    const auto drain_rows = [&](const detail::Table& table) {
      const Entity* entities = table.entities();
      const C* rows = detail::rows_of<C>(table.column_data(state_->component));
      state_->bits_of_table[table.id()].drain([&](std::uint32_t first, std::uint32_t count) {
        visited += count;
        f(std::span<const Entity>(entities + first, count),
          std::span<const C>(rows + first, count));
      });
    };
    if constexpr (is_sparse<C>()) {
      drain_rows(storage_->record(state_->component).sparse->rows());
      return visited;
    }
    for (const auto& table : storage_->tables()) {
      if (table == nullptr || !table->signature().contains(state_->component)) continue;
      drain_rows(*table);
    }
    return visited;
  }

  // Calls f(std::span<const Entity>) with the entities that died or lost C since the last call,
  // forgets them and returns their number. Entities of earlier verbs precede those of later verbs;
  // within one verb the order is undefined. Entities that gained and lost C in between are
  // included. The span is valid during the call. Only for readers made with Removed::kReport.
  template <class F>
  std::size_t drain_removed(F&& f) {
    PSYGEN_ECS_ASSERT(state_->reports_removed, "make the reader with Removed::kReport");
    state_->handed_out.clear();
    std::swap(state_->handed_out, state_->removed);
    const std::span<const Entity> removed = state_->handed_out;
    if (!removed.empty()) f(removed);
    return removed.size();
  }

 private:
  friend class World;
  ChangeReader(detail::Storage& storage, detail::ReaderState& state)
      : storage_(&storage), state_(&state) {}

  detail::Storage* storage_;
  detail::ReaderState* state_;
};

}  // namespace psygen::ecs
