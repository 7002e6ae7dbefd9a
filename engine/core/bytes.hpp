// Numbers as bytes in psygen's own formats: little-endian, without padding. Writing appends to a
// std::string or a std::vector<std::byte>. Reading trusts nothing: it checks a count before it
// allocates memory, and after the first missing byte the reader has failed and returns zeros. Knows
// no files. O(1) a number. An object belongs to one thread.
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

// Appends the bytes of many values of one type, or of values one after the other.
template <class T, class Bytes>
void put_all(Bytes& out, std::span<const T> values) {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(typename Bytes::value_type) == 1);
  const std::size_t before = out.size();
  out.resize(before + values.size_bytes());
  if (!values.empty()) std::memcpy(out.data() + before, values.data(), values.size_bytes());
}
template <class Bytes, class... T>
void put(Bytes& out, T... values) {
  (put_all(out, std::span<const T>(&values, 1)), ...);
}
// Appends a number in groups of 7 bits, the lowest first: 1 … 10 bytes.
template <class Bytes>
void put_varint(Bytes& out, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7)
    put(out, static_cast<std::uint8_t>(0x80 | (value & 0x7F)));
  put(out, static_cast<std::uint8_t>(value));
}

// Reads bytes from first to last. The bytes must outlive the reader.
class ByteReader {
 public:
  // Starts at the first byte.
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  explicit ByteReader(std::string_view bytes) : bytes_(std::as_bytes(std::span(bytes))) {}

  // Returns the next number; 0 if too few bytes are left.
  template <class T>
  T get() {
    T value{};
    const auto from = next(sizeof value);
    if (!failed_) std::memcpy(&value, from.data(), sizeof value);
    return value;
  }
  // Reads the next numbers one after the other; those for which too few bytes are left become 0.
  template <class... T>
  void read(T&... values) {
    ((values = get<T>()), ...);
  }
  // Returns the next `count` numbers; an empty list if too few bytes are left.
  template <class T>
  std::vector<T> get_all(std::size_t count) {
    if (count > bytes_.size() / sizeof(T)) failed_ = true;
    if (failed_) return {};
    std::vector<T> values(count);
    const auto from = next(count * sizeof(T));
    if (count > 0) std::memcpy(values.data(), from.data(), from.size());
    return values;
  }
  // Returns the next `bytes` bytes as a view into the input.
  std::string_view get_text(std::size_t bytes) {
    const auto from = next(bytes);
    return {reinterpret_cast<const char*>(from.data()), from.size()};
  }
  // Reads a number below 2^63 that put_varint() wrote.
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
  // Reads a 32-bit count of elements of at least `each_bytes` bytes each. The reader fails if that
  // many elements do not fit into the rest.
  std::size_t get_count(std::size_t each_bytes) {
    const auto count = get<std::uint32_t>();
    if (count > bytes_.size() / each_bytes) failed_ = true;
    return failed_ ? 0 : count;
  }

  // True if any read so far found too few bytes.
  bool failed() const { return failed_; }
  // Number of bytes not yet read.
  std::size_t left() const { return bytes_.size(); }

 private:
  // Returns the next bytes; if too few are left, none, and the reader has failed.
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
