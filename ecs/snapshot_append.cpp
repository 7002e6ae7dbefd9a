// Appending a snapshot: loads it into a separate world, then moves its rows to the target.
#include <algorithm>
#include <new>
#include <numeric>

#include "ecs/snapshot.hpp"
#include "ecs/snapshot_format.hpp"

namespace psygen::ecs {
namespace detail {
namespace {

// Memory for rows of a component during an exchange.
class Scratch {
 public:
  Scratch(const ComponentInfo& info, std::size_t rows)
      : alignment_(static_cast<std::align_val_t>(info.alignment)),
        bytes_(::operator new(std::max<std::size_t>(rows* info.size_bytes, 1), alignment_)) {}
  ~Scratch() { ::operator delete(bytes_, alignment_); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  std::byte* data() const { return static_cast<std::byte*>(bytes_); }

 private:
  std::align_val_t alignment_;
  void* bytes_;
};

class Appender {
 public:
  Appender(Storage& from, Storage& to) : from_(from), to_(to) {
    new_handles_.resize(from.slots().used(), kNullEntity);
  }

  // Returns the limit of the world that the append would exceed; empty if none.
  std::string refusal() const {
    if (from_.slots().living() + to_.slots().living() + to_.slots().retired() >
        to_.limits().max_entities)
      return "more entities than WorldLimits::max_entities";
    std::size_t kinds = to_.tables().size() - 1;
    for (const Table* table : filled_tables()) {
      const Table* same = table_of(table->signature());
      kinds += same == nullptr ? 1 : 0;
      if (table->rows() + (same == nullptr ? 0 : same->rows()) > to_.limits().max_rows_per_table)
        return "a table has more rows than WorldLimits::max_rows_per_table";
    }
    for (const auto& record : from_.records()) {
      if (record->sparse == nullptr) continue;
      const auto& same = to_.record(to_.find_id(*record->info)).sparse;
      if (record->sparse->rows().rows() + (same == nullptr ? 0 : same->rows().rows()) >
          to_.limits().max_rows_per_table)
        return "a table has more rows than WorldLimits::max_rows_per_table";
    }
    return kinds > to_.limits().max_tables ? "more archetypes than WorldLimits::max_tables" : "";
  }

  // If memory ends, the world has no new entity and the exception passes through.
  std::vector<Entity> run() {
    try {
      for (const Table* table : filled_tables())
        create_rows(*table);
      for (const Table* table : filled_tables())
        move_rows(*table);
      for (const auto& record : from_.records())
        if (record->sparse != nullptr) move_members(*record);
    } catch (...) {
      to_.destroy(all_);
      throw;
    }
    return std::move(all_);
  }

 private:
  std::vector<const Table*> filled_tables() const {
    std::vector<const Table*> filled;
    for (const auto& table : from_.tables())
      if (table != nullptr && table->rows() > 0) filled.push_back(table.get());
    return filled;
  }
  const Table* table_of(const Signature& kind) const {
    for (const auto& table : to_.tables())
      if (table != nullptr && table->signature() == kind) return table.get();
    return nullptr;
  }
  Entity new_handle(Entity old) const {
    return from_.living(old) != nullptr ? new_handles_[old.index] : kNullEntity;
  }

  // Both worlds number the components alike.
  void create_rows(const Table& table) {
    const Storage::Batch batch = to_.create(table.signature(), table.rows());
    const Entity* made = batch.table->entities() + batch.first;
    all_.insert(all_.end(), made, made + table.rows());
    for (std::uint32_t row = 0; row < table.rows(); ++row)
      new_handles_[table.entities()[row].index] = made[row];
    batches_.push_back(batch);
  }

  void move_rows(const Table& table) {
    const Storage::Batch batch = batches_[moved_tables_++];
    for (const Column& column : table.columns()) {
      std::byte* const target = batch.table->column_data(column.id);
      if (is_children(*column.info)) {
        move_children(reinterpret_cast<const Children*>(column.memory.data()), table.rows(),
                      reinterpret_cast<Children*>(target) + batch.first);
      } else {
        swap_rows(*column.info, column.memory.data(), target, batch.first, table.rows());
        follow(*column.info, target, batch.first, table.rows());
      }
    }
  }

  // Every row on both sides holds an object before and after the swap.
  static void swap_rows(const ComponentInfo& info, std::byte* source, std::byte* target,
                        std::size_t first, std::size_t count) {
    const Scratch scratch(info, count);
    std::vector<std::uint32_t> rows(count), target_rows(count);
    std::iota(rows.begin(), rows.end(), 0U);
    std::iota(target_rows.begin(), target_rows.end(), static_cast<std::uint32_t>(first));
    info.relocate_into(scratch.data(), 0, target, target_rows.data(), count);
    info.relocate_into(target, first, source, rows.data(), count);
    info.relocate_into(source, 0, scratch.data(), rows.data(), count);
  }

  void move_children(const Children* lists, std::size_t count, Children* target) {
    for (std::size_t row = 0; row < count; ++row) {
      std::vector<Entity> children;
      for (const Entity child : from_.child_lists().of(lists[row]))
        if (const Entity made = new_handle(child); made != kNullEntity) children.push_back(made);
      to_.set_children(target[row], children);
    }
  }

  void move_members(const ComponentRecord& record) {
    const Table& members = record.sparse->rows();
    if (members.rows() == 0) return;
    const ComponentId id = to_.find_id(*record.info);
    std::vector<Entity> entities;
    for (std::uint32_t row = 0; row < members.rows(); ++row)
      entities.push_back(new_handle(members.entities()[row]));
    to_.add_sparse(id, entities);  // in this order, after existing members
    SparseSet& set = *to_.record(id).sparse;
    const std::size_t first = set.row_of(entities.front());
    swap_rows(*record.info, record.sparse->column(), set.column(), first, entities.size());
    follow(*record.info, set.column(), first, entities.size());
  }

  // Redirects handles in the values of these rows to the new entities.
  void follow(const ComponentInfo& info, std::byte* column, std::size_t first,
              std::size_t count) const {
    const TypeDescription* type = described(info);
    if (type == nullptr) return;
    for (std::size_t row = first; row < first + count; ++row)
      follow(*type, column + row * info.size_bytes);
  }
  void follow(const TypeDescription& type, std::byte* at) const {
    const auto each = [&](std::byte* elements, std::size_t count) {
      for (std::size_t i = 0; i < count; ++i)
        follow(*type.element, elements + i * type.element->size_bytes);
    };
    if (type.kind == FieldKind::kEntity) {
      Entity entity;
      std::memcpy(&entity, at, sizeof(entity));
      entity = new_handle(entity);
      std::memcpy(at, &entity, sizeof(entity));
    } else if (type.kind == FieldKind::kStruct) {
      for (const FieldDescription& field : type.fields)
        follow(*field.type, at + field.offset_bytes);
    } else if (type.kind == FieldKind::kArray) {
      each(at, type.count);
    } else if (type.kind == FieldKind::kList) {
      each(type.resize(at, type.length(at)), type.length(at));
    }
  }

  Storage& from_;
  Storage& to_;
  std::vector<Entity> new_handles_;  // by the old index
  std::vector<Storage::Batch> batches_;
  std::size_t moved_tables_ = 0;
  std::vector<Entity> all_;
};

// Limits as large as the snapshot could need, because address space may be limited.
WorldLimits limits_for(std::size_t bytes, const WorldLimits& limits) {
  WorldLimits part = limits;
  part.max_entities = std::min(limits.max_entities, bytes / sizeof(std::uint32_t) + 1);
  part.max_rows_per_table = std::min(limits.max_rows_per_table, bytes / sizeof(Entity) + 1);
  return part;
}

}  // namespace
}  // namespace detail

SnapshotResult append_snapshot(std::span<const std::byte> bytes, World& world,
                               std::vector<Entity>* appended) {
  detail::Storage& to = detail::SnapshotAccess::storage(world);
  to.expect_no_iteration("append_snapshot");
  World part(detail::limits_for(bytes.size(), to.limits()));
  detail::Storage& from = detail::SnapshotAccess::storage(part);
  for (const auto& record : to.records())
    from.id_of(*record->info);
  if (SnapshotResult loaded = load_snapshot(bytes, part); !loaded) return loaded;
  detail::Appender appender(from, to);
  if (const std::string refusal = appender.refusal(); !refusal.empty())
    return {SnapshotStatus::kTooLarge, "snapshot: " + refusal};
  std::vector<Entity> all = appender.run();
  if (appended != nullptr) *appended = std::move(all);
  return {};
}

}  // namespace psygen::ecs
