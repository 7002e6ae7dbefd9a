// Numbers as bytes in formats of our own, little-endian, one after the other. Writing appends to a
// std::string or a std::vector<std::byte>. Reading trusts nothing: a count is checked before memory
// is taken, and once anything is missing the reader has failed and gives zeros. Knows no files.
// O(1) a number. An object belongs to one thread.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace psygen::core {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they are");

// Appends the bytes of values of one type, and of a single one.
template <class T, class Bytes>
void put_all(Bytes& out, std::span<const T> values) {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(typename Bytes::value_type) == 1);
  const std::size_t before = out.size();
  out.resize(before + values.size_bytes());
  if (!values.empty()) std::memcpy(out.data() + before, values.data(), values.size_bytes());
}
template <class T, class Bytes>
void put(Bytes& out, T value) {
  put_all(out, std::span<const T>(&value, 1));
}
// Appends 7 bits a byte, the least first: 1 … 10 bytes.
template <class Bytes>
void put_varint(Bytes& out, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7)
    put(out, static_cast<std::uint8_t>(0x80 | (value & 0x7F)));
  put(out, static_cast<std::uint8_t>(value));
}

// Reads bytes from the first to the last. They must outlive it.
class ByteReader {
 public:
  // Reads `bytes`, which must outlive it, from the start.
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  explicit ByteReader(std::string_view bytes) : bytes_(std::as_bytes(std::span(bytes))) {}

  // The next number; 0 where there is none.
  template <class T>
  T get() {
    T value{};
    const auto from = next(sizeof value);
    if (!failed_) std::memcpy(&value, from.data(), sizeof value);
    return value;
  }
  // The next `count` numbers; none where there are not so many.
  template <class T>
  std::vector<T> get_all(std::size_t count) {
    if (count > bytes_.size() / sizeof(T)) failed_ = true;
    if (failed_) return {};
    std::vector<T> values(count);
    const auto from = next(count * sizeof(T));
    if (count > 0) std::memcpy(values.data(), from.data(), from.size());
    return values;
  }
  // The next `bytes` bytes as text, in place.
  std::string_view get_text(std::size_t bytes) {
    const auto from = next(bytes);
    return {reinterpret_cast<const char*>(from.data()), from.size()};
  }
  // What put_varint() wrote, below 2^63.
  std::uint64_t get_varint() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 63; shift += 7) {
      const auto byte = get<std::uint8_t>();
      value |= std::uint64_t{byte & 0x7Fu} << shift;
      if (byte < 0x80) return failed_ ? 0 : value;
    }
    failed_ = true;
    return 0;
  }
  // A 32-bit count of things of at least `each_bytes` bytes, for all of which there must be room.
  std::size_t get_count(std::size_t each_bytes) {
    const auto count = get<std::uint32_t>();
    if (count > bytes_.size() / each_bytes) failed_ = true;
    return failed_ ? 0 : count;
  }

  // Whether anything was missing so far.
  bool failed() const { return failed_; }
  // How many bytes were not read yet.
  std::size_t left() const { return bytes_.size(); }

 private:
  // The next bytes; none, and failed, where there are too few.
  std::span<const std::byte> next(std::size_t count) {
    if (count > bytes_.size()) failed_ = true;
    if (failed_) return {};
    const auto from = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return from;
  }

  std::span<const std::byte> bytes_;
  bool failed_ = false;
};

}  // namespace psygen::core
