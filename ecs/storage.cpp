#include "ecs/storage.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace psygen::ecs::detail {
namespace {

// Gives columns that are walked together different offsets in a page.
std::size_t skew_bytes(std::size_t column) {
  return (column + 1) * 320 % 4096;
}

std::size_t place_of(const ComponentInfo& info, std::size_t places) {
  const auto address = reinterpret_cast<std::uintptr_t>(&info);
  return static_cast<std::size_t>((address >> 3) * 0x9E3779B97F4A7C15ull >> 40) % places;
}

WorldLimits clamped(WorldLimits limits) {
  constexpr std::size_t kMax = UINT32_MAX - 1;
  limits.max_entities = std::min(limits.max_entities, kMax);
  limits.max_rows_per_table = std::min(limits.max_rows_per_table, kMax);
  return limits;
}

}  // namespace

Storage::Storage(const WorldLimits& limits)
    : limits_(clamped(limits)), slots_(limits_.max_entities, limits_.first_generation) {
  tables_.emplace_back(nullptr);
  absent_.origin_of_chunk.assign(directory_.chunk_count(), 0);
  id_index_.fill(kNoComponent);
}

Storage::~Storage() = default;

ComponentId Storage::find_id(const ComponentInfo& info) const {
  for (std::size_t i = place_of(info, id_index_.size());; i = (i + 1) % id_index_.size()) {
    const ComponentId id = id_index_[i];
    if (id == kNoComponent || records_[id]->info == &info) return id;
  }
}

ComponentId Storage::id_of(const ComponentInfo& info) {
  if (const ComponentId known = find_id(info); known != kNoComponent) return known;
  if (records_.size() == kMaxComponents) give_up("more than 256 component types in one world");
  for (const auto& other : records_) {
    if (other->info->name != info.name) continue;
    give_up("two component types are named '" + std::string(info.name) +
            "': change one ComponentTraits<>::name");
  }
  const auto id = static_cast<ComponentId>(records_.size());
  auto& record = *records_.emplace_back(std::make_unique<ComponentRecord>());
  record.info = &info;
  record.origin_of_chunk.assign(directory_.chunk_count(), 0);
  std::size_t i = place_of(info, id_index_.size());
  while (id_index_[i] != kNoComponent)
    i = (i + 1) % id_index_.size();
  id_index_[i] = id;
  if (&info == &kComponentInfo<Children>) children_id_ = id;
  if (info.sparse) {
    record.sparse =
        std::make_unique<SparseSet>(id, info, limits_.max_entities, limits_.max_rows_per_table);
    sparse_sets_.push_back(record.sparse.get());
  }
  return id;
}

Table& Storage::table_for(const Signature& kind) {
  Table*& table = table_of_[kind];
  if (table == nullptr) table = &make_table(kind);
  return *table;
}

Table& Storage::make_table(const Signature& kind) {
  if (tables_.size() > limits_.max_tables) give_up("more archetypes than WorldLimits::max_tables");
  const auto id = static_cast<std::uint32_t>(tables_.size());
  std::vector<Column> columns;
  for (std::size_t c = 0; c < records_.size(); ++c) {
    if (!kind.contains(static_cast<ComponentId>(c))) continue;
    const ComponentInfo& info = *records_[c]->info;
    columns.push_back(
        {&info, static_cast<ComponentId>(c),
         ReservedMemory(limits_.max_rows_per_table * info.size_bytes, skew_bytes(columns.size()))});
  }
  Table& table = *tables_.emplace_back(
      std::make_unique<Table>(id, kind, std::move(columns), limits_.max_rows_per_table));
  for (std::size_t c = 0; c < records_.size(); ++c) {
    for (auto& reader : records_[c]->readers)
      reader->bits_of_table.emplace_back();
  }
  return table;
}

// Commits memory for `count` more rows and records the addresses of new chunks for every component.
void Storage::make_room(Table& table, std::size_t count) {
  const std::size_t known = directory_.chunk_count();
  table.reserve_more(count);
  table.name_rows(count, directory_);
  absent_.origin_of_chunk.resize(directory_.chunk_count());
  for (std::size_t chunk = known; chunk < directory_.chunk_count(); ++chunk) {
    const std::uintptr_t location = chunk * kChunkRows;
    const RowPlace first = directory_.place_of(static_cast<std::uint32_t>(location));
    for (std::size_t c = 0; c < records_.size(); ++c) {
      const auto column =
          reinterpret_cast<std::uintptr_t>(table.column_data(static_cast<ComponentId>(c)));
      const std::uintptr_t size_bytes = records_[c]->info->size_bytes;
      records_[c]->origin_of_chunk.push_back(
          column == 0 ? 0 : column + (first.row - location) * size_bytes);
    }
  }
}

template <class F>
void Storage::for_each_reader(const Table& table, F&& f) {
  for (const Column& column : table.columns()) {
    for (auto& reader : records_[column.id]->readers)
      f(*reader);
  }
}

void Storage::mark_new_rows(const Table& table, std::uint32_t first, std::size_t count,
                            const Signature& which) {
  for_each_reader(table, [&](ReaderState& reader) {
    RowBits& bits = reader.bits_of_table[table.id()];
    bits.reserve_rows(table.rows());
    if (which.contains(reader.component)) {
      bits.mark_range(first, static_cast<std::uint32_t>(count));
    }
  });
}

Storage::Batch Storage::create(const Signature& kind, std::size_t count) {
  expect_no_iteration("create");
  Table& table = table_for(kind);
  make_room(table, count);
  slots_.reserve_more(count);
  table.construct_new_rows(count, Signature{});
  const std::uint32_t first = table.add_rows(count);
  for (std::size_t done = 0; done < count;) {  // neighbours in a chunk have neighbouring locations
    const std::uint32_t row = first + static_cast<std::uint32_t>(done);
    const std::size_t step = std::min<std::size_t>(count - done, kChunkRows - row % kChunkRows);
    slots_.issue({table.entities() + row, step}, table.location(row));
    done += step;
  }
  mark_new_rows(table, first, count, kind);
  return {&table, first};
}

Storage::Batch Storage::restore_rows(const Signature& kind, std::span<const Entity> entities) {
  Table& table = table_for(kind);
  make_room(table, entities.size());
  table.construct_new_rows(entities.size(), Signature{});
  const std::uint32_t first = table.add_rows(entities.size());
  std::ranges::copy(entities, table.entities() + first);
  for (std::uint32_t row = first; row < table.rows(); ++row)
    slots_[table.entities()[row].index].location = table.location(row);
  mark_new_rows(table, first, entities.size(), kind);
  return {&table, first};
}

void Storage::forget_restored() {
  std::vector<Entity> all;
  for (const auto& table : tables_) {
    if (table != nullptr)
      all.insert(all.end(), table->entities(), table->entities() + table->rows());
  }
  destroy(all);
  slots_.restore({}, {});
  ever_sparse_.clear();
}

void Storage::report_removed(const Table& table, const Signature& which) {
  for_each_reader(table, [&](ReaderState& reader) {
    if (!reader.reports_removed || !which.contains(reader.component)) return;
    for (const std::uint32_t row : table.leaving)
      reader.removed.push_back(table.entities()[row]);
  });
}

// Destroys the objects of the leaving rows in the columns of `which`, and frees their child lists.
void Storage::end_leaving_rows(Table& table, const Signature& which) {
  if (children_id_ != kNoComponent && which.contains(children_id_)) {
    if (std::byte* column = table.column_data(children_id_)) {
      for (const std::uint32_t row : table.leaving)
        child_lists_.release(rows_of<Children>(column)[row]);
    }
  }
  table.destroy_rows(table.leaving, which);
}

// Moves the change bits after the moves in `moves_` and the shortening of the table.
void Storage::move_leaving_bits(Table& table, std::uint32_t old_rows) {
  for_each_reader(table, [&](ReaderState& reader) {
    RowBits& bits = reader.bits_of_table[table.id()];
    if (!bits.any()) return;
    for (const RowMove& move : moves_)
      bits.copy_bit(move.to, bits, move.from);
    bits.clear_range(table.rows(), old_rows - table.rows());
  });
  table.leaving.clear();
}

// Fills the holes of the leaving rows, which hold no objects, and updates handles and change bits.
void Storage::remove_leaving_rows(Table& table) {
  const std::uint32_t old_rows = table.rows();
  table.close_holes(table.leaving, moves_);
  const Entity* entities = table.entities();
  for (std::size_t i = 0; i < moves_.size(); ++i) {
    if (i + kPrefetchAhead < moves_.size()) {
      slots_.prefetch(entities[moves_[i + kPrefetchAhead].to]);
    }
    slots_[entities[moves_[i].to].index].location = table.location(moves_[i].to);
  }
  move_leaving_bits(table, old_rows);
}

void Storage::remove_leaving_members(SparseSet& set) {
  Table& rows = set.rows();
  if (rows.leaving.empty()) return;
  report_removed(rows, rows.signature());
  rows.destroy_rows(rows.leaving, rows.signature());
  const std::uint32_t old_rows = rows.rows();
  rows.close_holes(rows.leaving, moves_);
  for (const RowMove& move : moves_)
    set.note_moved(move.to);
  move_leaving_bits(rows, old_rows);
}

std::size_t Storage::add_sparse(ComponentId id, std::span<const Entity> entities) {
  expect_no_iteration("add");
  SparseSet& set = *records_[id]->sparse;
  const std::uint32_t first = set.rows().rows();
  const std::size_t added = set.add(entities, slots_);
  mark_new_rows(set.rows(), first, added, set.rows().signature());
  ever_sparse_.resize(slots_.used() / 64 + 1);
  const Entity* members = set.rows().entities();
  for (std::size_t row = first; row < first + added; ++row)
    ever_sparse_[members[row].index / 64] |= std::uint64_t{1} << (members[row].index % 64);
  return added;
}

std::size_t Storage::remove_sparse(ComponentId id, std::span<const Entity> entities) {
  expect_no_iteration("remove");
  SparseSet& set = *records_[id]->sparse;
  for (std::size_t i = 0; i < entities.size(); ++i) {
    if (i + kPrefetchAhead < entities.size()) set.prefetch(entities[i + kPrefetchAhead]);
    set.leave(entities[i]);
  }
  const std::size_t left = set.rows().leaving.size();
  remove_leaving_members(set);
  return left;
}

void Storage::leave_sparse_sets(Entity entity) {
  const std::size_t word = entity.index / 64;
  const std::uint64_t bit = std::uint64_t{1} << (entity.index % 64);
  if (word >= ever_sparse_.size() || (ever_sparse_[word] & bit) == 0) return;
  ever_sparse_[word] &= ~bit;
  for (SparseSet* set : sparse_sets_)
    set->leave(entity);
}

std::size_t Storage::destroy(std::span<const Entity> entities) {
  expect_no_iteration("destroy");
  std::size_t died = 0;
  for (std::size_t i = 0; i < entities.size(); ++i) {
    if (i + kPrefetchAhead < entities.size()) slots_.prefetch(entities[i + kPrefetchAhead]);
    Slot* slot = living(entities[i]);
    if (slot == nullptr) continue;
    const RowPlace at = directory_.place_of(slot->location);
    Table& table = *tables_[at.table];
    if (table.leaving.empty()) touched_.push_back(&table);
    table.leaving.push_back(at.row);
    slots_.release(*slot);
    leave_sparse_sets(entities[i]);
    ++died;
  }
  for (SparseSet* set : sparse_sets_)
    remove_leaving_members(*set);
  for (Table* table : touched_) {
    report_removed(*table, table->signature());
    end_leaving_rows(*table, table->signature());
    remove_leaving_rows(*table);
  }
  touched_.clear();
  return died;
}

std::size_t Storage::change_archetype(std::span<const Entity> entities, const Signature& added,
                                      const Signature& removed) {
  expect_no_iteration("add or remove");
  const Table* last = nullptr;
  bool last_changes = false;
  std::size_t moved = 0;
  for (std::size_t i = 0; i < entities.size(); ++i) {
    if (i + kPrefetchAhead < entities.size()) slots_.prefetch(entities[i + kPrefetchAhead]);
    Slot* slot = living(entities[i]);
    if (slot == nullptr || slot->location == kInTransit) continue;
    const RowPlace at = directory_.place_of(slot->location);
    Table& table = *tables_[at.table];
    if (&table != last) {
      last = &table;
      last_changes = !(table.signature().changed(added, removed) == table.signature());
    }
    if (!last_changes) continue;
    if (table.leaving.empty()) touched_.push_back(&table);
    table.leaving.push_back(at.row);
    slot->location = kInTransit;
    ++moved;
  }

  // If a component's constructor throws, entities that have not moved yet are unchanged.
  struct Unwind {
    Storage& storage;
    ~Unwind() {
      for (Table* table : storage.touched_) {
        for (const std::uint32_t row : table->leaving) {
          storage.slots_[table->entities()[row].index].location = table->location(row);
        }
        table->leaving.clear();
      }
      storage.touched_.clear();
    }
  } const unwind{*this};
  for (Table* table : touched_) {
    transfer(*table, table_for(table->signature().changed(added, removed)));
  }
  return moved;
}

void Storage::transfer(Table& source, Table& target) {
  const std::size_t count = source.leaving.size();
  make_room(target, count);
  target.construct_new_rows(count, source.signature());
  const std::uint32_t first = target.add_rows(count);
  report_removed(source, source.signature().changed({}, target.signature()));
  mark_new_rows(target, first, count, target.signature().changed({}, source.signature()));

  for (const Column& column : target.columns()) {
    std::byte* from = source.column_data(column.id);
    if (from == nullptr) continue;
    column.info->relocate_into(column.memory.data(), first, from, source.leaving.data(), count);
    for (auto& reader : records_[column.id]->readers) {
      const RowBits& old_bits = reader->bits_of_table[source.id()];
      RowBits& new_bits = reader->bits_of_table[target.id()];
      for (std::size_t i = 0; i < count && old_bits.any(); ++i) {
        new_bits.copy_bit(first + static_cast<std::uint32_t>(i), old_bits, source.leaving[i]);
      }
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Entity entity = source.entities()[source.leaving[i]];
    const std::uint32_t row = first + static_cast<std::uint32_t>(i);
    target.entities()[row] = entity;
    slots_[entity.index].location = target.location(row);
  }
  end_leaving_rows(source, source.signature().changed({}, target.signature()));
  remove_leaving_rows(source);
}

Children* Storage::children_of(Entity entity) const {
  const Slot* slot = living(entity);
  if (slot == nullptr || children_id_ == kNoComponent) return nullptr;
  return row_at<Children>(*records_[children_id_], slot->location);
}

ReaderState& Storage::add_reader(ComponentId id, bool reports_removed) {
  auto& reader = *records_[id]->readers.emplace_back(std::make_unique<ReaderState>());
  reader.component = id;
  reader.reports_removed = reports_removed;
  reader.bits_of_table.resize(tables_.size());
  if (const SparseSet* set = records_[id]->sparse.get()) {
    reader.bits_of_table[0].reserve_rows(set->rows().rows());
    reader.bits_of_table[0].mark_range(0, set->rows().rows());
  }
  for (const auto& table : tables_) {
    if (table == nullptr || !table->signature().contains(id)) continue;
    reader.bits_of_table[table->id()].reserve_rows(table->rows());
    reader.bits_of_table[table->id()].mark_range(0, table->rows());
  }
  return reader;
}

void Storage::remove_reader(const ReaderState& reader) {
  std::erase_if(records_[reader.component]->readers,
                [&](const auto& owned) { return owned.get() == &reader; });
}

void Storage::structural_change_inside(std::string_view verb) const {
  std::string sentence = "structural change (";
  sentence.append(verb).append(") while iterating <");
  const auto* query = iteration_.query.load(std::memory_order_relaxed);
  for (std::size_t i = 0; query != nullptr && i < query->size(); ++i) {
    if (i > 0) sentence += ", ";
    if (!(*query)[i].writes) sentence += "const ";
    sentence.append((*query)[i].name);
  }
  give_up(sentence += ">; record it in Commands and apply them afterwards");
}

std::size_t Storage::committed_bytes() const {
  std::size_t bytes = slots_.committed_bytes() + child_lists_.committed_bytes();
  for (const SparseSet* set : sparse_sets_)
    bytes += set->committed_bytes();
  for (const auto& table : tables_) {
    if (table != nullptr) bytes += table->committed_bytes();
  }
  return bytes;
}

}  // namespace psygen::ecs::detail
