#include "ecs/snapshot_reader.hpp"

#include <algorithm>

namespace psygen::ecs::detail {
namespace {

constexpr std::uint32_t kDeepestType = 32;  // levels of nested types
constexpr std::size_t kLongestSkippedArray = std::size_t{1} << 20;

class TypeReader {
 public:
  TypeReader(SnapshotReader& in, const std::string& name) : in_(in) { path_.push_back(name); }

  void read(SavedType& type, const TypeDescription* own) {
    if (path_.size() > kDeepestType) {
      in_.corrupt("types are nested too deeply");
      return;
    }
    const auto kind = in_.number<std::uint8_t>();
    if (kind > static_cast<std::uint8_t>(FieldKind::kList)) {
      in_.corrupt("unknown kind of field");
      return;
    }
    type.kind = static_cast<FieldKind>(kind);
    type.own = own;
    if (own != nullptr && own->kind != type.kind) return mismatch();
    switch (type.kind) {
      case FieldKind::kStruct:
        return read_fields(type);
      case FieldKind::kArray:
        type.count = in_.number<std::uint32_t>();
        if (own == nullptr && type.count > kLongestSkippedArray)
          in_.corrupt("an array is too long");
        if (own != nullptr && own->count != type.count) return mismatch();
        return read_element(type);
      case FieldKind::kList:
        return read_element(type);
      default:
        return read_scalar(type);
    }
  }

 private:
  void mismatch() {
    std::string path;
    for (const std::string& part : path_)
      path += path.empty() ? part : "." + part;
    in_.refuse(SnapshotStatus::kTypeMismatch, path + " has another type now");
  }

  void read_fields(SavedType& type) {
    const std::uint32_t fields = in_.length(5);
    for (std::uint32_t i = 0; i < fields && in_.ok(); ++i) {
      path_.push_back(in_.name());
      const FieldDescription* own = nullptr;
      if (type.own != nullptr) {
        const auto found =
            std::ranges::find(type.own->fields, path_.back(), &FieldDescription::name);
        if (found != type.own->fields.end()) own = &*found;
      }
      SavedType part;
      part.offset_bytes = own == nullptr ? 0 : own->offset_bytes;
      read(part, own == nullptr ? nullptr : own->type);
      // Drops a field that takes no bytes: it needs no work, however often it is repeated.
      if (in_.ok() && part.has_bytes()) type.parts.push_back(std::move(part));
      path_.pop_back();
    }
  }

  void read_element(SavedType& type) {
    path_.emplace_back("[]");
    read(type.parts.emplace_back(), type.own == nullptr ? nullptr : type.own->element);
    path_.pop_back();
    if (in_.ok() && !type.parts[0].has_bytes()) in_.corrupt("a list of elements without bytes");
  }

  void read_scalar(SavedType& type) {
    type.size_bytes = in_.number<std::uint32_t>();
    if (type.kind == FieldKind::kString) return;
    if (type.own != nullptr && type.own->size_bytes != type.size_bytes) return mismatch();
    const std::size_t s = type.size_bytes;
    if (s != 1 && s != 2 && s != 4 && s != 8 && s != 16) in_.corrupt("a number has an odd size");
  }

  SnapshotReader& in_;
  std::vector<std::string> path_;
};

}  // namespace

std::string SnapshotReader::name() {
  const std::uint32_t count = length(1);
  if (count > kLongestName) {
    corrupt("a name is too long");
    return {};
  }
  const std::byte* from = take(count);
  return from == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(from), count);
}

SavedType read_saved_type(SnapshotReader& in, const TypeDescription* own, const std::string& name) {
  SavedType type;
  TypeReader(in, name).read(type, own);
  return type;
}

}  // namespace psygen::ecs::detail
