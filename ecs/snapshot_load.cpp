// Loading in two passes over the same bytes: the first checks everything and changes nothing, the
// second fills the world. Only a throwing constructor or allocation can stop the second pass, which
// then undoes its changes.
#include <algorithm>
#include <cstring>
#include <utility>

#include "ecs/snapshot.hpp"
#include "ecs/snapshot_format.hpp"
#include "ecs/snapshot_reader.hpp"

namespace psygen::ecs {
namespace detail {
namespace {

using Status = SnapshotStatus;

struct SavedComponent {
  ComponentId id = kNoComponent;
  std::string name;
  bool described = false;
  SavedType type;
};

class Loader {
 public:
  Loader(std::span<const std::byte> bytes, Storage& storage) : in_(bytes), storage_(storage) {}

  SnapshotResult load() {
    storage_.expect_no_iteration("load_snapshot");
    if (!header() || !components() || !check_rest()) return in_.take_result();
    try {
      fill_rest();
    } catch (...) {
      storage_.forget_restored();
      throw;
    }
    return in_.take_result();
  }

 private:
  bool header() {
    if (storage_.slots().used() > 0) {
      return in_.refuse(Status::kWorldInUse, "only a world that never had an entity can be loaded");
    }
    const std::span<const std::byte> bytes = in_.bytes();
    const std::size_t magic = kSnapshotMagic.size();
    if (bytes.size() < magic || std::memcmp(bytes.data(), kSnapshotMagic.data(), magic) != 0) {
      return in_.refuse(Status::kNotASnapshot, "the bytes are not a snapshot");
    }
    if (bytes.size() < kSnapshotHeaderBytes + kSnapshotChecksumBytes) {
      return in_.refuse(Status::kTruncated, "it ends within its header");
    }
    in_.go_to(magic);
    const auto version = in_.number<std::uint32_t>();
    if (version > kSnapshotVersion) {
      return in_.refuse(Status::kNewerVersion, "version " + std::to_string(version) +
                                                   " is newer than " +
                                                   std::to_string(kSnapshotVersion));
    }
    if (version == 0) return in_.corrupt("version 0 does not exist");
    return length_and_checksum();
  }

  bool length_and_checksum() {
    const auto length = in_.number<std::uint64_t>();
    const std::uint64_t there = in_.size() - kSnapshotHeaderBytes - kSnapshotChecksumBytes;
    if (length > there) {
      return in_.refuse(Status::kTruncated,
                        std::to_string(length - there) + " bytes are missing at its end");
    }
    if (length < there) return in_.corrupt("it has bytes after its end");
    const auto content = in_.bytes().first(in_.size() - kSnapshotChecksumBytes);
    std::uint64_t sum = 0;
    std::memcpy(&sum, in_.bytes().data() + content.size(), sizeof(sum));
    if (checksum(content) != sum) return in_.corrupt("the checksum does not match");
    in_.end_at(content.size());
    return true;
  }

  bool components() {
    for (std::uint32_t left = in_.length(6); left > 0 && in_.ok(); --left) {
      SavedComponent component;
      component.name = in_.name();
      const bool sparse = in_.number<std::uint8_t>() != 0;
      component.described = in_.number<std::uint8_t>() != 0;
      if (!in_.ok()) break;
      const auto known = std::ranges::find_if(storage_.records(), [&](const auto& record) {
        return record->info->name == component.name;
      });
      if (known == storage_.records().end()) {
        return in_.refuse(Status::kUnknownComponent,
                          "this world does not know the component '" + component.name +
                              "'; call World::declare<…>() with its type before loading");
      }
      component.id = static_cast<ComponentId>(known - storage_.records().begin());
      if (std::ranges::find(components_, component.id, &SavedComponent::id) != components_.end()) {
        return in_.corrupt("a component is listed twice");
      }
      const ComponentInfo& info = *(*known)->info;
      if (info.sparse != sparse) {
        return in_.refuse(Status::kTypeMismatch, component.name + " has another storage now");
      }
      if (component.described)
        component.type = read_saved_type(in_, described(info), component.name);
      components_.push_back(std::move(component));
    }
    return in_.ok();
  }

  // ---- values: checked when `to` is null, else written -----------------------------------------

  void value(const SavedType& type, std::byte* to) {
    if (type.own == nullptr) to = nullptr;
    switch (type.kind) {
      case FieldKind::kStruct:
        for (const SavedType& part : type.parts)
          value(part, to == nullptr ? nullptr : to + part.offset_bytes);
        return;
      case FieldKind::kArray:
        return elements(type, type.count, to);
      case FieldKind::kList: {
        const std::uint32_t length = in_.length(1);
        count_memory(type, length);
        return elements(type, length, to == nullptr ? nullptr : type.own->resize(to, length));
      }
      case FieldKind::kString: {
        const std::uint32_t length = in_.length(1);
        const std::byte* from = in_.take(length);
        if (to != nullptr && from != nullptr)
          std::copy_n(from, length, type.own->resize(to, length));
        return;
      }
      default: {
        const std::byte* from = in_.take(type.size_bytes);
        if (from == nullptr) return;
        if (type.kind == FieldKind::kBool && *from > std::byte{1})
          in_.corrupt("a bool is neither 0 nor 1");
        if (to != nullptr) std::memcpy(to, from, type.size_bytes);
      }
    }
  }
  void elements(const SavedType& type, std::size_t count, std::byte* to) {
    const std::size_t step = type.own == nullptr ? 0 : type.own->element->size_bytes;
    for (std::size_t i = 0; i < count && in_.ok(); ++i)
      value(type.parts[0], to == nullptr ? nullptr : to + i * step);
  }
  // Elements may be larger in the program than in the snapshot, within bounds.
  void count_memory(const SavedType& type, std::uint32_t length) {
    if (type.own == nullptr) return;
    list_bytes_ += std::uint64_t{length} * type.own->element->size_bytes;
    if (list_bytes_ > kListMemoryFactor * in_.size())
      in_.refuse(Status::kTooLarge, "its lists would take far more memory than it has bytes");
  }

  void column(const SavedComponent& component, std::size_t rows, std::byte* to) {
    if (!component.described) return;
    const ComponentInfo& info = *storage_.record(component.id).info;
    in_.set_context(", component '" + component.name + "'");
    if (!is_children(info) && !component.type.has_bytes()) rows = 0;
    for (std::size_t row = 0; row < rows && in_.ok(); ++row) {
      if (!is_children(info)) {
        value(component.type, to == nullptr ? nullptr : to + row * info.size_bytes);
      } else {
        const std::vector<Entity> list = handles();
        if (to != nullptr) storage_.set_children(reinterpret_cast<Children*>(to)[row], list);
      }
    }
    in_.set_context({});
  }

  std::vector<Entity> handles() {
    const std::uint32_t count = in_.length(sizeof(Entity));
    const std::byte* from = in_.take(count * sizeof(Entity));
    std::vector<Entity> result(from == nullptr ? 0 : count);
    if (!result.empty())
      std::memcpy(static_cast<void*>(result.data()), from, count * sizeof(Entity));
    return result;
  }

  // ---- first pass -----------------------------------------------------------------------------

  bool check_rest() {
    rest_ = in_.at();
    check_slots() && check_tables() && check_sparse_sets();
    if (in_.ok() && in_.left() > 0) in_.corrupt("it has bytes after its end");
    if (in_.ok() && std::ranges::count(owner_, Owner::kNobody) > 0) in_.corrupt("a slot is lost");
    return in_.ok();
  }

  enum class Owner : std::uint8_t { kNobody, kFree, kRetired, kTable };

  bool too_large(std::string_view what, std::string_view limit) {
    return in_.refuse(Status::kTooLarge,
                      std::string(what) + " than WorldLimits::" + std::string(limit));
  }

  bool check_slots() {
    const std::uint32_t slots = in_.length(sizeof(std::uint32_t));
    if (slots > storage_.limits().max_entities) return too_large("more entities", "max_entities");
    for (std::uint32_t i = 0; i < slots; ++i) {
      generations_.push_back(in_.number<std::uint32_t>());
      owner_.push_back(generations_.back() == 0 ? Owner::kRetired : Owner::kNobody);
    }
    for (std::uint32_t left = in_.length(sizeof(std::uint32_t)); left > 0; --left) {
      free_.push_back(in_.number<std::uint32_t>());
      if (free_.back() >= slots || owner_[free_.back()] != Owner::kNobody)
        return in_.corrupt("a slot is free twice");
      owner_[free_.back()] = Owner::kFree;
    }
    return in_.ok();
  }

  bool lives(Entity e) const {
    return e.index < generations_.size() && generations_[e.index] == e.generation;
  }
  bool check_rows(std::span<const Entity> rows) {
    if (rows.size() <= storage_.limits().max_rows_per_table) return in_.ok();
    return too_large("a table has more rows", "max_rows_per_table");
  }

  bool check_tables() {
    std::vector<Signature> kinds;
    for (std::uint32_t left = in_.length(8); left > 0 && in_.ok(); --left) {
      const auto [numbers, kind] = read_kind();
      if (std::ranges::find(kinds, kind) != kinds.end())
        return in_.corrupt("an archetype is listed twice");
      kinds.push_back(kind);
      if (storage_.tables().size() - 1 + kinds.size() > storage_.limits().max_tables)
        return too_large("more archetypes", "max_tables");
      const std::vector<Entity> rows = handles();
      if (!check_rows(rows)) return false;
      if (rows.empty()) return in_.corrupt("a table has no rows");
      for (const Entity e : rows) {
        if (!lives(e) || owner_[e.index] != Owner::kNobody)
          return in_.corrupt("an entity is listed twice");
        owner_[e.index] = Owner::kTable;
      }
      for (const std::uint32_t number : numbers)
        column(components_[number], rows.size(), nullptr);
    }
    return in_.ok();
  }

  bool check_sparse_sets() {
    std::vector<bool> seen(components_.size());
    for (std::uint32_t left = in_.length(8); left > 0 && in_.ok(); --left) {
      const auto number = in_.number<std::uint32_t>();
      if (number >= components_.size() || seen[number] || !is_sparse(number))
        return in_.corrupt("a sparse component is not sparse");
      seen[number] = true;
      std::vector<bool> member(owner_.size());
      const std::vector<Entity> rows = handles();
      if (!check_rows(rows)) return false;
      for (const Entity e : rows) {
        if (!lives(e) || owner_[e.index] != Owner::kTable || member[e.index])
          return in_.corrupt("a sparse component belongs to no entity");
        member[e.index] = true;
      }
      column(components_[number], rows.size(), nullptr);
    }
    return in_.ok();
  }

  bool is_sparse(std::uint32_t number) const {
    return storage_.record(components_[number].id).info->sparse;
  }

  // Reads the component numbers of a table, and the archetype that they form. Empty if they are
  // invalid.
  std::pair<std::vector<std::uint32_t>, Signature> read_kind() {
    std::vector<std::uint32_t> numbers(in_.length(sizeof(std::uint32_t)));
    Signature kind;
    for (std::uint32_t& number : numbers) {
      number = in_.number<std::uint32_t>();
      if (number >= components_.size() || is_sparse(number) ||
          kind.contains(components_[number].id)) {
        in_.corrupt("a table has a column that it cannot have");
        return {};
      }
      kind.insert(components_[number].id);
    }
    return {std::move(numbers), kind};
  }

  // ---- second pass ----------------------------------------------------------------------------

  void fill_rest() {
    in_.go_to(rest_ + sizeof(std::uint32_t) * (2 + generations_.size() + free_.size()));
    storage_.restore_slots(generations_, free_);
    for (std::uint32_t left = in_.length(8); left > 0; --left) {
      const auto [numbers, kind] = read_kind();
      const std::vector<Entity> rows = handles();
      const Storage::Batch batch = storage_.restore_rows(kind, rows);
      for (const std::uint32_t number : numbers) {
        const SavedComponent& component = components_[number];
        column(component, rows.size(), batch.table->column_data(component.id));
      }
    }
    for (std::uint32_t left = in_.length(8); left > 0; --left) {
      const SavedComponent& component = components_[in_.number<std::uint32_t>()];
      const std::vector<Entity> rows = handles();
      storage_.add_sparse(component.id, rows);
      column(component, rows.size(), storage_.record(component.id).sparse->column());
    }
  }

  static constexpr std::uint64_t kListMemoryFactor = 256;

  SnapshotReader in_;
  std::size_t rest_ = 0;  // where slots, tables and sparse sets begin
  std::uint64_t list_bytes_ = 0;
  Storage& storage_;
  std::vector<SavedComponent> components_;
  std::vector<std::uint32_t> generations_;
  std::vector<std::uint32_t> free_;
  std::vector<Owner> owner_;  // of each slot
};

}  // namespace
}  // namespace detail

SnapshotResult load_snapshot(std::span<const std::byte> bytes, World& world) {
  return detail::Loader(bytes, detail::SnapshotAccess::storage(world)).load();
}

}  // namespace psygen::ecs
