// Loading in two passes over the same bytes: the first checks everything and changes nothing, the
// second fills the world and cannot fail.
#include <algorithm>
#include <cstring>
#include <utility>

#include "ecs/snapshot.hpp"
#include "ecs/snapshot_format.hpp"

namespace psygen::ecs {
namespace detail {
namespace {

using Status = SnapshotStatus;

// A type as the snapshot tells it. Fields name what the world's own type has at their place.
struct SavedType {
  FieldKind kind = FieldKind::kStruct;
  std::size_t size_bytes = 0;            // scalars
  std::size_t count = 0;                 // arrays
  std::vector<SavedType> parts;          // fields, or the one element
  const TypeDescription* own = nullptr;  // null: what is read is skipped
  std::size_t offset_bytes = 0;

  bool has_bytes() const {
    if (kind == FieldKind::kStruct) return !parts.empty();
    return kind != FieldKind::kArray || (count > 0 && parts[0].has_bytes());
  }
};

struct SavedComponent {
  ComponentId id = kNoComponent;
  bool described = false;
  SavedType type;
};

class Loader {
 public:
  Loader(std::span<const std::byte> bytes, Storage& storage) : in_(bytes), storage_(storage) {}

  SnapshotResult load() {
    if (header() && components() && check_rest()) fill_rest();
    return std::move(result_);
  }

 private:
  bool refuse(Status status, std::string sentence) {
    if (result_) result_ = {status, std::move(sentence)};
    return false;
  }
  bool corrupt(std::string_view what) {
    return refuse(Status::kCorrupt, "snapshot: " + std::string(what));
  }

  // ---- bytes; a read beyond the end is refused and gives zero ---------------------------------

  std::size_t left() const { return in_.size() - at_; }
  const std::byte* take(std::size_t count) {
    if (count > left()) {
      corrupt("a list is longer than the data");
      return nullptr;
    }
    return in_.data() + std::exchange(at_, at_ + count);
  }
  template <class T>
  T number() {
    T value{};
    if (const std::byte* from = take(sizeof(T))) std::memcpy(&value, from, sizeof(T));
    return value;
  }
  // A count of things that take at least `least_bytes` each.
  std::uint32_t count(std::size_t least_bytes) {
    const auto value = number<std::uint32_t>();
    if (value > left() / least_bytes) {
      corrupt("a list is longer than the data");
      return 0;
    }
    return value;
  }
  std::string string() {
    const std::uint32_t length = count(1);
    const std::byte* from = take(length);
    return from == nullptr ? std::string()
                           : std::string(reinterpret_cast<const char*>(from), length);
  }

  bool header() {
    if (storage_.slots().used() > 0) {
      return refuse(Status::kWorldInUse, "snapshot: only a world without a past can be loaded");
    }
    const std::size_t magic = kSnapshotMagic.size();
    if (in_.size() < magic || std::memcmp(in_.data(), kSnapshotMagic.data(), magic) != 0) {
      return refuse(Status::kNotASnapshot, "snapshot: these bytes are no snapshot");
    }
    at_ = magic;
    if (in_.size() < kSnapshotHeaderBytes + kSnapshotChecksumBytes) {
      return refuse(Status::kTruncated, "snapshot: it ends within its header");
    }
    const auto version = number<std::uint32_t>();
    if (version > kSnapshotVersion) {
      return refuse(Status::kNewerVersion, "snapshot: version " + std::to_string(version) +
                                               " is newer than " +
                                               std::to_string(kSnapshotVersion));
    }
    if (version == 0) return corrupt("there is no version 0");
    const auto length = number<std::uint64_t>();
    const std::uint64_t there = in_.size() - kSnapshotHeaderBytes - kSnapshotChecksumBytes;
    if (length > there) {
      return refuse(Status::kTruncated, "snapshot: " + std::to_string(length - there) +
                                            " bytes are missing at its end");
    }
    if (length < there) return corrupt("something follows after its end");
    std::uint64_t sum = 0;
    const auto protected_bytes = in_.first(in_.size() - kSnapshotChecksumBytes);
    std::memcpy(&sum, in_.data() + protected_bytes.size(), sizeof(sum));
    if (checksum(protected_bytes) != sum) return corrupt("the checksum does not fit");
    in_ = protected_bytes;
    return true;
  }

  // ---- types ----------------------------------------------------------------------------------

  bool mismatch(const std::string& path) {
    return refuse(Status::kTypeMismatch, "snapshot: " + path + " has another type now");
  }

  static bool is_scalar(FieldKind kind) {
    return kind != FieldKind::kStruct && kind != FieldKind::kArray && kind != FieldKind::kList &&
           kind != FieldKind::kString;
  }

  // `own` is what the world has there; null where it has nothing any more.
  bool read_type(SavedType& type, const TypeDescription* own, const std::string& path,
                 std::uint32_t depth) {
    if (depth > kDeepestType) return corrupt("types are nested too deeply");
    const auto kind = number<std::uint8_t>();
    if (kind > static_cast<std::uint8_t>(FieldKind::kList)) return corrupt("unknown kind of field");
    type.kind = static_cast<FieldKind>(kind);
    type.own = own;
    if (own != nullptr && own->kind != type.kind) return mismatch(path);
    switch (type.kind) {
      case FieldKind::kStruct:
        return read_fields(type, path, depth);
      case FieldKind::kArray:
        type.count = number<std::uint32_t>();
        if (type.count > kLongestArray) return corrupt("an array is too long");
        if (own != nullptr && own->count != type.count) return mismatch(path);
        break;
      case FieldKind::kList:
        break;
      default:
        return read_scalar(type, path);
    }
    return read_type(type.parts.emplace_back(), own == nullptr ? nullptr : own->element, path,
                     depth + 1);
  }

  bool read_fields(SavedType& type, const std::string& path, std::uint32_t depth) {
    const std::uint32_t fields = count(5);
    for (std::uint32_t i = 0; i < fields && result_; ++i) {
      const std::string name = string();
      const FieldDescription* own = nullptr;
      if (type.own != nullptr) {
        const auto found = std::ranges::find(type.own->fields, name, &FieldDescription::name);
        if (found != type.own->fields.end()) own = &*found;
      }
      SavedType& part = type.parts.emplace_back();
      part.offset_bytes = own == nullptr ? 0 : own->offset_bytes;
      read_type(part, own == nullptr ? nullptr : own->type, path + "." + name, depth + 1);
      // What takes no bytes is no work either, however often it is repeated.
      if (result_ && !part.has_bytes()) type.parts.pop_back();
    }
    return bool(result_);
  }

  bool read_scalar(SavedType& type, const std::string& path) {
    type.size_bytes = number<std::uint32_t>();
    if (type.kind == FieldKind::kString) return bool(result_);
    if (type.own != nullptr && type.own->size_bytes != type.size_bytes) return mismatch(path);
    const std::size_t s = type.size_bytes;
    if (s != 1 && s != 2 && s != 4 && s != 8 && s != 16) return corrupt("a number has an odd size");
    return bool(result_);
  }

  bool components() {
    const std::uint32_t number_of_components = count(6);
    for (std::uint32_t i = 0; i < number_of_components && result_; ++i) {
      const std::string name = string();
      const bool sparse = number<std::uint8_t>() != 0;
      SavedComponent& component = components_.emplace_back();
      component.described = number<std::uint8_t>() != 0;
      if (!result_) break;
      const auto known = std::ranges::find_if(
          storage_.records(), [&](const auto& record) { return record->info->name == name; });
      if (known == storage_.records().end()) {
        return refuse(Status::kUnknownComponent,
                      "snapshot: this world does not know the component '" + name + "'");
      }
      component.id = static_cast<ComponentId>(known - storage_.records().begin());
      for (std::size_t k = 0; k + 1 < components_.size(); ++k) {
        if (components_[k].id == component.id) return corrupt("a component is there twice");
      }
      const ComponentInfo& info = *(*known)->info;
      if (info.sparse != sparse) return mismatch(name);
      if (component.described) read_type(component.type, described(info), name, 0);
    }
    return bool(result_);
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
        elements(type, type.count, to);
        return;
      case FieldKind::kList: {
        const std::uint32_t length = count(1);
        elements(type, length, to == nullptr ? nullptr : type.own->resize(to, length));
        return;
      }
      case FieldKind::kString: {
        const std::uint32_t length = count(1);
        const std::byte* from = take(length);
        if (to != nullptr && from != nullptr)
          std::copy_n(from, length, type.own->resize(to, length));
        return;
      }
      default: {
        const std::byte* from = take(type.size_bytes);
        if (from == nullptr) return;
        if (type.kind == FieldKind::kBool && *from > std::byte{1}) corrupt("a bool is neither");
        if (to != nullptr) std::memcpy(to, from, type.size_bytes);
      }
    }
  }
  void elements(const SavedType& type, std::size_t number_of_elements, std::byte* to) {
    const SavedType& element = type.parts[0];
    if (!element.has_bytes()) return;
    const std::size_t step = type.own == nullptr ? 0 : type.own->element->size_bytes;
    for (std::size_t i = 0; i < number_of_elements && result_; ++i)
      value(element, to == nullptr ? nullptr : to + i * step);
  }

  void column(const SavedComponent& component, std::size_t rows, std::byte* to) {
    if (!component.described) return;
    const ComponentInfo& info = *storage_.record(component.id).info;
    for (std::size_t row = 0; row < rows && result_; ++row) {
      if (!is_children(info)) {
        value(component.type, to == nullptr ? nullptr : to + row * info.size_bytes);
        continue;
      }
      const std::uint32_t length = count(sizeof(Entity));
      const std::byte* handles = take(length * sizeof(Entity));
      if (to == nullptr || handles == nullptr || length == 0) continue;
      std::vector<Entity> list(length);
      std::memcpy(static_cast<void*>(list.data()), handles, length * sizeof(Entity));
      storage_.set_children(reinterpret_cast<Children*>(to)[row], list);
    }
  }

  std::span<const Entity> handles() {
    const std::uint32_t rows = count(sizeof(Entity));
    const std::byte* from = take(rows * sizeof(Entity));
    handles_.resize(rows);
    if (from != nullptr && rows > 0) {
      std::memcpy(static_cast<void*>(handles_.data()), from, rows * sizeof(Entity));
    }
    return handles_;
  }

  // ---- first pass -----------------------------------------------------------------------------

  bool check_rest() {
    rest_ = at_;
    check_slots() && check_tables() && check_sparse_sets();
    if (result_ && left() > 0) corrupt("something follows after its end");
    if (result_ && std::ranges::count(owner_, Owner::kNobody) > 0) corrupt("a slot is lost");
    return bool(result_);
  }

  enum class Owner : std::uint8_t { kNobody, kFree, kRetired, kTable };

  bool check_slots() {
    const std::uint32_t slots = count(sizeof(std::uint32_t));
    if (slots > storage_.limits().max_entities) {
      return refuse(Status::kTooLarge, "snapshot: " + std::to_string(slots) +
                                           " entities are more than WorldLimits::max_entities");
    }
    for (std::uint32_t i = 0; i < slots; ++i) {
      generations_.push_back(number<std::uint32_t>());
      owner_.push_back(generations_.back() == 0 ? Owner::kRetired : Owner::kNobody);
    }
    const std::uint32_t free = count(sizeof(std::uint32_t));
    for (std::uint32_t i = 0; i < free && result_; ++i) {
      free_.push_back(number<std::uint32_t>());
      if (free_.back() >= slots || owner_[free_.back()] != Owner::kNobody) {
        return corrupt("a slot is free twice");
      }
      owner_[free_.back()] = Owner::kFree;
    }
    return bool(result_);
  }

  bool lives(Entity e) const {
    return e.index < generations_.size() && generations_[e.index] == e.generation;
  }

  bool check_tables() {
    const std::uint32_t tables = count(8);
    std::vector<Signature> kinds;
    for (std::uint32_t t = 0; t < tables && result_; ++t) {
      const auto [ids, kind] = read_kind();
      if (std::ranges::find(kinds, kind) != kinds.end()) return corrupt("a kind is there twice");
      kinds.push_back(kind);
      const std::span<const Entity> rows = handles();
      if (rows.size() > storage_.limits().max_rows_per_table) {
        return refuse(Status::kTooLarge,
                      "snapshot: a table has more rows than WorldLimits::max_rows_per_table");
      }
      for (const Entity e : rows) {
        if (!lives(e) || owner_[e.index] != Owner::kNobody)
          return corrupt("an entity is there twice");
        owner_[e.index] = Owner::kTable;
      }
      for (const std::uint32_t id : ids)
        column(components_[id], rows.size(), nullptr);
    }
    return bool(result_);
  }

  bool check_sparse_sets() {
    const std::uint32_t sets = count(8);
    std::vector<bool> seen(components_.size());
    for (std::uint32_t s = 0; s < sets && result_; ++s) {
      const auto id = number<std::uint32_t>();
      if (id >= components_.size() || seen[id] || !is_sparse(id))
        return corrupt("a sparse component is none");
      seen[id] = true;
      std::vector<bool> member(owner_.size());
      const std::span<const Entity> rows = handles();
      for (const Entity e : rows) {
        if (!lives(e) || owner_[e.index] != Owner::kTable || member[e.index]) {
          return corrupt("a sparse component belongs to nobody");
        }
        member[e.index] = true;
      }
      column(components_[id], rows.size(), nullptr);
    }
    return bool(result_);
  }

  bool is_sparse(std::uint32_t id) const {
    return storage_.record(components_[id].id).info->sparse;
  }

  // The component numbers of a table, and the kind that they make. Empty when they make none.
  std::pair<std::vector<std::uint32_t>, Signature> read_kind() {
    std::vector<std::uint32_t> ids(count(sizeof(std::uint32_t)));
    Signature kind;
    for (std::uint32_t& id : ids) {
      id = number<std::uint32_t>();
      if (id >= components_.size() || is_sparse(id) || kind.contains(components_[id].id)) {
        corrupt("a table has a column that it cannot have");
        return {};
      }
      kind.insert(components_[id].id);
    }
    return {std::move(ids), kind};
  }

  // ---- second pass ----------------------------------------------------------------------------

  void fill_rest() {
    at_ = rest_;
    storage_.restore_slots(generations_, free_);
    at_ += sizeof(std::uint32_t) * (2 + generations_.size() + free_.size());
    for (std::uint32_t tables = count(8); tables > 0; --tables) {
      const auto [ids, kind] = read_kind();
      const std::span<const Entity> rows = handles();
      const Storage::Batch batch = storage_.restore_rows(kind, rows);
      for (const std::uint32_t id : ids)
        column(components_[id], rows.size(), batch.table->column_data(components_[id].id));
    }
    for (std::uint32_t sets = count(8); sets > 0; --sets) {
      const SavedComponent& component = components_[number<std::uint32_t>()];
      const std::span<const Entity> rows = handles();
      storage_.add_sparse(component.id, rows);
      column(component, rows.size(), storage_.record(component.id).sparse->column());
    }
  }

  static constexpr std::size_t kLongestArray = std::size_t{1} << 20;

  std::span<const std::byte> in_;
  std::size_t at_ = 0;
  std::size_t rest_ = 0;  // where slots, tables and sparse sets begin
  Storage& storage_;
  SnapshotResult result_;
  std::vector<SavedComponent> components_;
  std::vector<std::uint32_t> generations_;
  std::vector<std::uint32_t> free_;
  std::vector<Owner> owner_;     // of each slot
  std::vector<Entity> handles_;  // scratch
};

}  // namespace
}  // namespace detail

SnapshotResult load_snapshot(std::span<const std::byte> bytes, World& world) {
  return detail::Loader(bytes, detail::SnapshotAccess::storage(world)).load();
}

}  // namespace psygen::ecs
