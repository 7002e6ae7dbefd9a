// Reads a snapshot: a cursor over its bytes that rejects reads past the end, and the snapshot's
// types, matched with those of the program. Not the loader: it changes no world. Internal to the
// library; used by one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ecs/fields.hpp"
#include "ecs/snapshot.hpp"

namespace psygen::ecs::detail {

// Keeps the first error; after it every read returns zero. Offsets and sizes are in bytes.
class SnapshotReader {
 public:
  explicit SnapshotReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  // Position of the cursor, and the number of bytes after it.
  std::size_t at() const { return at_; }
  void go_to(std::size_t at) { at_ = at; }
  std::size_t left() const { return bytes_.size() - at_; }
  std::size_t size() const { return bytes_.size(); }
  // Cuts the bytes to the first `size`. The cursor stays.
  void end_at(std::size_t size) { bytes_ = bytes_.first(size); }
  std::span<const std::byte> bytes() const { return bytes_; }

  // True if no error occurred.
  bool ok() const { return bool(result_); }
  // Moves the result out.
  SnapshotResult take_result() { return std::move(result_); }
  // Records an error unless one is recorded already; returns false. corrupt() adds the position.
  bool refuse(SnapshotStatus status, std::string sentence) {
    if (result_) result_ = {status, "snapshot: " + std::move(sentence)};
    return false;
  }
  bool corrupt(std::string_view what) {
    return refuse(SnapshotStatus::kCorrupt,
                  std::string(what) + " (at byte " + std::to_string(at_) + context_ + ")");
  }
  // Sets the subject for messages of corrupt().
  void set_context(std::string context) { context_ = std::move(context); }

  // Moves past `count` bytes and returns their address; null if fewer are left.
  const std::byte* take(std::size_t count) {
    if (count > left()) {
      corrupt("a list is longer than the data");
      return nullptr;
    }
    return bytes_.data() + std::exchange(at_, at_ + count);
  }
  // Reads the next sizeof(T) bytes as a number; 0 if fewer are left.
  template <class T>
  T number() {
    T value{};
    if (const std::byte* from = take(sizeof(T))) std::memcpy(&value, from, sizeof(T));
    return value;
  }
  // Reads a count of elements that take at least `min_bytes` each; 0 if the bytes left cannot
  // hold them.
  std::uint32_t length(std::size_t min_bytes) {
    const auto value = number<std::uint32_t>();
    if (value <= left() / min_bytes) return value;
    corrupt("a list is longer than the data");
    return 0;
  }
  // Reads a string of at most 1024 bytes. A longer one is corrupt.
  std::string name();

 private:
  static constexpr std::size_t kLongestName = 1024;
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
  SnapshotResult result_;
  std::string context_;
};

// A type as declared in the snapshot.
struct SavedType {
  FieldKind kind = FieldKind::kStruct;
  std::size_t size_bytes = 0;            // of a scalar
  std::size_t count = 0;                 // of an array
  std::vector<SavedType> parts;          // fields that take bytes, or the one element
  const TypeDescription* own = nullptr;  // the program's type; null: the value is skipped
  std::size_t offset_bytes = 0;          // in the program's struct

  // True if a value of this type takes bytes in the snapshot.
  bool has_bytes() const {
    if (kind == FieldKind::kStruct) return !parts.empty();
    return kind != FieldKind::kArray || (count > 0 && parts[0].has_bytes());
  }
};

// Reads a type and compares it with `own`, the program's type of that name (null if it has none).
// Rejects types that changed, with a message that has `name` and the path of fields.
SavedType read_saved_type(SnapshotReader& in, const TypeDescription* own, const std::string& name);

}  // namespace psygen::ecs::detail
