#include <algorithm>

#include "ecs/snapshot.hpp"
#include "ecs/snapshot_format.hpp"

namespace psygen::ecs {
namespace detail {
namespace {

// Saves all entities, or those that have one component, which it numbers anew.
class Saver {
 public:
  explicit Saver(const Storage& storage) : storage_(storage) {}
  Saver(const Storage& storage, ComponentId only) : storage_(storage), all_(false) {
    new_index_.assign(storage.slots().used(), kUnused);
    if (only == kNoComponent) return;
    if (const auto& set = storage.record(only).sparse; set != nullptr) keep(set->rows());
    for (const auto& table : storage.tables())
      if (table != nullptr && table->signature().contains(only)) keep(*table);
  }

  std::vector<std::byte> save() {
    bytes(kSnapshotMagic.data(), kSnapshotMagic.size());
    number(kSnapshotVersion);
    number(std::uint64_t{0});  // the length, filled in below
    components();
    slots();
    tables();
    sparse_sets();
    const std::uint64_t length = out_.size() - kSnapshotHeaderBytes;
    std::memcpy(out_.data() + kSnapshotHeaderBytes - sizeof(length), &length, sizeof(length));
    number(checksum(out_));
    return std::move(out_);
  }

 private:
  void bytes(const void* data, std::size_t count) {
    const std::size_t before = out_.size();
    out_.resize(before + count);
    if (count > 0) std::memcpy(out_.data() + before, data, count);
  }
  template <class T>
  void number(T value) {
    bytes(&value, sizeof(value));
  }
  void count(std::size_t value) { number(static_cast<std::uint32_t>(value)); }
  void string(std::string_view text) {
    count(text.size());
    bytes(text.data(), text.size());
  }

  void type(const TypeDescription& t) {
    number(static_cast<std::uint8_t>(t.kind));
    switch (t.kind) {
      case FieldKind::kStruct:
        count(t.fields.size());
        for (const FieldDescription& field : t.fields) {
          string(field.name);
          type(*field.type);
        }
        break;
      case FieldKind::kArray:
        count(t.count);
        type(*t.element);
        break;
      case FieldKind::kList:
        type(*t.element);
        break;
      default:
        count(t.size_bytes);
    }
  }

  // Collects the components that some entity has, sorted by name: the same state then gives the
  // same bytes, whatever the order in which the world registered its types.
  void components() {
    number_of_.assign(storage_.records().size(), kUnused);
    for (const auto& table : storage_.tables()) {
      if (table == nullptr || !any_of(*table)) continue;
      for (const Column& column : table->columns())
        number_of_[column.id] = 0;
    }
    for (std::size_t id = 0; id < number_of_.size(); ++id) {
      if (members(id) > 0) number_of_[id] = 0;
      if (number_of_[id] != kUnused) ids_.push_back(static_cast<ComponentId>(id));
    }
    std::ranges::sort(ids_, {}, [&](ComponentId id) { return storage_.record(id).info->name; });
    count(ids_.size());
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      number_of_[ids_[i]] = static_cast<std::uint32_t>(i);
      component(*storage_.record(ids_[i]).info);
    }
  }
  void component(const ComponentInfo& info) {
    const TypeDescription* description = described(info);
    string(info.name);
    number(static_cast<std::uint8_t>(info.sparse));
    number(static_cast<std::uint8_t>(description != nullptr));
    if (description != nullptr) type(*description);
  }
  std::size_t members(std::size_t id) const {
    const auto& set = storage_.records()[id]->sparse;
    return set == nullptr ? 0 : rows_of(set->rows()).size();
  }

  // ---- which entities -------------------------------------------------------------------------

  void keep(const Table& table) {
    for (std::uint32_t row = 0; row < table.rows(); ++row)
      new_index_[table.entities()[row].index] = new_count_++;
  }
  bool has(Entity entity) const {
    return all_ ||
           (storage_.slots().find(entity) != nullptr && new_index_[entity.index] != kUnused);
  }
  Entity saved(Entity entity) const {
    if (all_) return entity;
    return has(entity) ? Entity{new_index_[entity.index], 1} : kNullEntity;
  }
  std::vector<std::uint32_t> rows_of(const Table& table) const {
    std::vector<std::uint32_t> rows;
    rows.reserve(all_ ? table.rows() : 0);
    for (std::uint32_t row = 0; row < table.rows(); ++row)
      if (has(table.entities()[row])) rows.push_back(row);
    return rows;
  }
  bool any_of(const Table& table) const {
    const auto has_one = [this](Entity entity) { return has(entity); };
    return std::any_of(table.entities(), table.entities() + table.rows(), has_one);
  }

  void slots() {
    if (!all_) {
      count(new_count_);
      for (std::uint32_t i = 0; i < new_count_; ++i)
        number(std::uint32_t{1});  // generation
      return count(0);             // free
    }
    const EntitySlots& slots = storage_.slots();
    count(slots.used());
    for (std::uint32_t i = 0; i < slots.used(); ++i)
      number(slots[i].generation);
    count(slots.free().size());
    bytes(slots.free().data(), slots.free().size_bytes());
  }

  void value(const TypeDescription& t, const std::byte* at) {
    switch (t.kind) {
      case FieldKind::kStruct:
        for (const FieldDescription& field : t.fields)
          value(*field.type, at + field.offset_bytes);
        break;
      case FieldKind::kArray:
        for (std::size_t i = 0; i < t.count; ++i)
          value(*t.element, at + i * t.element->size_bytes);
        break;
      case FieldKind::kString:
      case FieldKind::kList: {
        const std::size_t length = t.length(at);
        const std::byte* elements = t.elements(at);
        count(length);
        for (std::size_t i = 0; i < length; ++i)
          value(*t.element, elements + i * t.element->size_bytes);
        break;
      }
      case FieldKind::kEntity: {
        Entity entity;
        std::memcpy(&entity, at, sizeof(entity));
        number(saved(entity));
        break;
      }
      default:
        bytes(at, t.size_bytes);
    }
  }

  void column(const Column& column, std::span<const std::uint32_t> rows) {
    const TypeDescription* description = described(*column.info);
    if (description == nullptr) return;
    const std::byte* first = column.memory.data();
    for (const std::size_t row : rows) {
      if (is_children(*column.info)) {
        children(storage_.child_lists().of(reinterpret_cast<const Children*>(first)[row]));
      } else {
        value(*description, first + row * column.info->size_bytes);
      }
    }
  }

  void children(std::span<const Entity> list) {
    const auto has_it = [this](Entity entity) { return has(entity); };
    count(static_cast<std::size_t>(std::ranges::count_if(list, has_it)));
    for (const Entity entity : list)
      if (has(entity)) number(saved(entity));
  }

  void handles(const Table& table, std::span<const std::uint32_t> rows) {
    count(rows.size());
    for (const std::uint32_t row : rows)
      number(saved(table.entities()[row]));
  }

  void tables() {
    std::size_t filled = 0;
    for (const auto& table : storage_.tables())
      filled += table != nullptr && any_of(*table) ? 1 : 0;
    count(filled);
    for (const auto& table : storage_.tables()) {
      if (table == nullptr || !any_of(*table)) continue;
      std::vector<const Column*> columns;
      for (const Column& c : table->columns())
        columns.push_back(&c);
      std::ranges::sort(columns, {}, [&](const Column* c) { return number_of_[c->id]; });
      count(columns.size());
      for (const Column* c : columns)
        count(number_of_[c->id]);
      const std::vector<std::uint32_t> rows = rows_of(*table);
      handles(*table, rows);
      for (const Column* c : columns)
        column(*c, rows);
    }
  }

  void sparse_sets() {
    std::vector<const Table*> sets;
    for (const ComponentId id : ids_) {
      if (members(id) > 0) sets.push_back(&storage_.record(id).sparse->rows());
    }
    count(sets.size());
    for (const Table* set : sets) {
      count(number_of_[set->columns()[0].id]);
      const std::vector<std::uint32_t> rows = rows_of(*set);
      handles(*set, rows);
      column(set->columns()[0], rows);
    }
  }

  static constexpr std::uint32_t kUnused = UINT32_MAX;
  const Storage& storage_;
  const bool all_ = true;
  std::vector<std::uint32_t> new_index_;  // by index; kUnused: not saved
  std::uint32_t new_count_ = 0;
  std::vector<std::byte> out_;
  std::vector<ComponentId> ids_;          // of the written components, in order
  std::vector<std::uint32_t> number_of_;  // index into ids_, by component id
};

}  // namespace

std::vector<std::byte> save_snapshot_of(const World& world, const ComponentInfo& component) {
  const Storage& storage = SnapshotAccess::storage(world);
  return Saver(storage, storage.find_id(component)).save();
}

}  // namespace detail

std::vector<std::byte> save_snapshot(const World& world) {
  return detail::Saver(detail::SnapshotAccess::storage(world)).save();
}

std::uint64_t state_hash(const World& world) {
  return detail::checksum(save_snapshot(world));
}

}  // namespace psygen::ecs
