// The untyped core of a world: component types, tables, sparse sets, handles, change bits, and the
// batch verbs that change structure. `World` adds types and is its only user. One thread changes
// it; const functions may run on several threads while nothing changes. Verbs are linear in the
// given handles or rows.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "ecs/children.hpp"
#include "ecs/component.hpp"
#include "ecs/entity.hpp"
#include "ecs/entity_slots.hpp"
#include "ecs/row_bits.hpp"
#include "ecs/row_directory.hpp"
#include "ecs/sparse_set.hpp"
#include "ecs/table.hpp"

namespace psygen::ecs {

// Limits of a world's size, given to World's constructor and fixed for its life. They reserve
// address space, not memory, so raising them is cheap; a column has at most 64 GiB. A verb that
// would exceed a limit ends the program with a message; load_snapshot rejects the snapshot instead.
struct WorldLimits {
  std::size_t max_entities = std::size_t{1} << 28;        // below 2^32
  std::size_t max_rows_per_table = std::size_t{1} << 26;  // below 2^32; also per sparse component
  std::size_t max_tables = 2048;  // a column is a mapping; systems grant some 65,000
  // The generation of a slot's first entity, at least 1. With a value near UINT32_MAX, slots retire
  // soon.
  std::uint32_t first_generation = 1;
};

namespace detail {

// The changes of a component that one consumer has not seen yet.
struct ReaderState {
  ComponentId component = kNoComponent;
  bool reports_removed = false;
  std::vector<RowBits> bits_of_table;  // by table id; [0] for a sparse component
  std::vector<Entity> removed;
  std::vector<Entity> handed_out;  // scratch of draining
};

// Data of a world per component type.
struct ComponentRecord {
  const ComponentInfo* info = nullptr;
  // By chunk: the address that the row at location 0 would have if the rows of this chunk continued
  // down to it. The address of a row is then one multiplication and one addition. 0 if the chunk's
  // table lacks the component.
  std::vector<std::uintptr_t> origin_of_chunk;
  std::unique_ptr<SparseSet> sparse;  // null for a component in tables
  std::vector<std::unique_ptr<ReaderState>> readers;
};

// Returns the row of a component at a location; null if its table lacks the component. O(1).
template <class C>
C* row_at(const ComponentRecord& record, std::uint32_t location) {
  const std::uintptr_t origin = record.origin_of_chunk[location / kChunkRows];
  if (origin == 0) return nullptr;
  C* const row = std::launder(reinterpret_cast<C*>(origin + std::uintptr_t{location} * sizeof(C)));
  if (row == nullptr) __builtin_unreachable();  // spares the caller a second null test
  return row;
}

// One component of a query, for messages. `name` has static storage.
struct QueryTerm {
  std::string_view name;
  bool writes;
};

// The components of a query, as an array and as a span with static storage.
template <class... Cs>
inline constexpr std::array<QueryTerm, sizeof...(Cs)> kQueryTerms{
    QueryTerm{component_name<std::remove_const_t<Cs>>(), !std::is_const_v<Cs>}...};
template <class... Cs>
inline constexpr std::span<const QueryTerm> kQuery{kQueryTerms<Cs...>};

// The query being iterated, during which structural changes violate the contract. Atomic because
// systems on several threads may iterate at the same time.
struct IterationState {
  std::atomic<std::uint32_t> depth{0};  // active iterations on all threads
  std::atomic<const std::span<const QueryTerm>*> query{nullptr};  // the latest; for messages only
};

// Counts one iteration as active during its lifetime.
class IterationGuard {
 public:
  // `state` and `query` must outlive the guard.
  IterationGuard(IterationState& state, const std::span<const QueryTerm>& query) : state_(state) {
    state_.depth.fetch_add(1, std::memory_order_relaxed);
    outer_ = state_.query.exchange(&query, std::memory_order_relaxed);
  }
  // Ends the iteration.
  ~IterationGuard() {
    state_.query.store(outer_, std::memory_order_relaxed);
    state_.depth.fetch_sub(1, std::memory_order_relaxed);
  }
  IterationGuard(const IterationGuard&) = delete;
  IterationGuard& operator=(const IterationGuard&) = delete;

 private:
  IterationState& state_;
  const std::span<const QueryTerm>* outer_;
};

// World's functions without types; World documents contracts and errors. A component is named by
// its id in this world, an archetype by the set of its ids.
class Storage {
 public:
  // Contiguous rows of a table, from `first` on. Valid until the next structural change.
  struct Batch {
    Table* table = nullptr;
    std::uint32_t first = 0;
  };

  // An empty storage. Limits above 2^32 - 2 entities or rows are lowered to that. Throws
  // std::bad_alloc if there is no address space for the slots.
  explicit Storage(const WorldLimits& limits);
  // Destroys all components.
  ~Storage();
  Storage(const Storage&) = delete;
  Storage& operator=(const Storage&) = delete;

  // Returns the id of a component type. id_of registers a new type and ends the program beyond 256
  // types or if two types share a name; find_id returns kNoComponent for a new type. O(1) for known
  // types.
  ComponentId id_of(const ComponentInfo& info);
  ComponentId find_id(const ComponentInfo& info) const;
  // The record of a registered id. Its address never changes.
  ComponentRecord& record(ComponentId id) { return *records_[id]; }
  const ComponentRecord& record(ComponentId id) const { return *records_[id]; }
  // Record of a component that this world does not know: no entity has it.
  const ComponentRecord& absent() const { return absent_; }
  // Component types by id, and tables by id; tables()[0] is null. Valid until the next registration
  // or new table.
  std::span<const std::unique_ptr<ComponentRecord>> records() const { return records_; }
  std::span<const std::unique_ptr<Table>> tables() const { return tables_; }
  // Locations of entities: the slots, and the directory that interprets them.
  const EntitySlots& slots() const { return slots_; }
  const RowDirectory& directory() const { return directory_; }

  // Returns the slot of a living entity, else null. O(1).
  Slot* living(Entity entity) const {
    Slot* slot = slots_.find(entity);
    return slot != nullptr && slot->location != kNowhere ? slot : nullptr;
  }

  // World::create: `count` entities of one archetype, in new contiguous rows.
  Batch create(const Signature& kind, std::size_t count);
  // World::destroy. Returns the number of entities that died.
  std::size_t destroy(std::span<const Entity> entities);
  // World::change_archetype for components in tables. Returns the number of entities that moved. If
  // a constructor throws, entities that have not moved yet are unchanged.
  std::size_t change_archetype(std::span<const Entity> entities, const Signature& added,
                               const Signature& removed);
  // World::add and World::remove for one sparse component. Return the number of changed entities.
  std::size_t add_sparse(ComponentId id, std::span<const Entity> entities);
  std::size_t remove_sparse(ComponentId id, std::span<const Entity> entities);
  // World::reserve.
  void reserve(const Signature& kind, std::size_t count) {
    expect_no_iteration("reserve");
    make_room(table_for(kind), count);
  }

  // Makes a reader, to which all rows are new. The storage owns it; its address never changes.
  ReaderState& add_reader(ComponentId id, bool reports_removed);
  // Deletes a reader that add_reader returned.
  void remove_reader(const ReaderState& reader);
  // Mark rows as changed for all readers of the component. Rows must be filled; `table` is a table
  // id.
  static void mark(ComponentRecord& record, RowPlace at) {
    for (auto& reader : record.readers)
      reader->bits_of_table[at.table].mark(at.row);
  }
  static void mark(ComponentRecord& record, std::span<const RowPlace> rows) {
    for (auto& reader : record.readers) {
      RowBits* const bits_of_table = reader->bits_of_table.data();
      for (const RowPlace at : rows)
        bits_of_table[at.table].mark(at.row);
    }
  }
  static void mark_range(ComponentRecord& record, std::uint32_t table, std::uint32_t first,
                         std::uint32_t count) {
    for (auto& reader : record.readers)
      reader->bits_of_table[table].mark_range(first, count);
  }

  // Ends the program with a message that names `verb` if a query is being iterated.
  void expect_no_iteration(std::string_view verb) const {
    if (iteration_.depth.load(std::memory_order_relaxed) != 0) structural_change_inside(verb);
  }
  // For IterationGuard. Also changes in a const storage.
  IterationState& iteration() const { return iteration_; }
  // Committed bytes of slots, children, tables and sparse sets.
  std::size_t committed_bytes() const;

  // The lists that Children components name.
  const ChildLists& child_lists() const { return child_lists_; }
  // Returns the entity's Children; null if it is dead or has none.
  Children* children_of(Entity entity) const;
  // Replaces the list. `children` must not be a list of this storage.
  void set_children(Children& list, std::span<const Entity> children) {
    expect_no_iteration("set_children");
    child_lists_.assign(list, children);
  }

  // The limits after lowering.
  const WorldLimits& limits() const { return limits_; }
  // For loading into a world that never had an entity: first restores the slots, then rows for
  // handles that these slots know.
  void restore_slots(std::span<const std::uint32_t> generations,
                     std::span<const std::uint32_t> free) {
    slots_.restore(generations, free);
  }
  // Makes one row per handle, in this order, with value-initialised components.
  Batch restore_rows(const Signature& kind, std::span<const Entity> entities);
  // Undoes restore_slots, restore_rows and add_sparse: no entities and no slots remain.
  void forget_restored();

 private:
  [[noreturn]] void structural_change_inside(std::string_view verb) const;
  Table& table_for(const Signature& kind);
  Table& make_table(const Signature& kind);
  void make_room(Table& table, std::size_t count);
  void mark_new_rows(const Table& table, std::uint32_t first, std::size_t count,
                     const Signature& which);
  void report_removed(const Table& table, const Signature& which);
  void leave_sparse_sets(Entity entity);
  void end_leaving_rows(Table& table, const Signature& which);
  void move_leaving_bits(Table& table, std::uint32_t old_rows);
  void remove_leaving_rows(Table& table);
  void remove_leaving_members(SparseSet& set);
  void transfer(Table& source, Table& target);
  template <class F>
  void for_each_reader(const Table& table, F&& f);

  WorldLimits limits_;
  EntitySlots slots_;
  RowDirectory directory_;
  std::vector<std::unique_ptr<ComponentRecord>> records_;
  ComponentRecord absent_;
  std::vector<SparseSet*> sparse_sets_;
  std::vector<std::uint64_t> ever_sparse_;  // one bit per entity index: it may be in a sparse set
  ChildLists child_lists_;
  ComponentId children_id_ = kNoComponent;
  std::vector<std::unique_ptr<Table>> tables_;
  std::unordered_map<Signature, Table*, Signature::Hash> table_of_;
  std::array<ComponentId, 2 * kMaxComponents> id_index_;  // open addressing by ComponentInfo*
  std::vector<Table*> touched_;                           // scratch of the batch verbs
  std::vector<RowMove> moves_;
  mutable IterationState iteration_;
};

}  // namespace detail
}  // namespace psygen::ecs
