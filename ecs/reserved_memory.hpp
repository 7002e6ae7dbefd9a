// A range of address space, reserved once and backed by memory as it grows, so its contents never
// move. Fresh memory reads as zero. Large ranges request huge pages. Not a container: it knows
// bytes, not objects. Growing costs one system call; the first touch of a page costs its page
// fault. Owned by one thread at a time.
#pragma once

#include <cstddef>

namespace psygen::ecs::detail {

// Owns its mapping and unmaps it on destruction.
class ReservedMemory {
 public:
  // An empty range: no address, no bytes.
  ReservedMemory() = default;
  // Reserves `bytes` of address space, at most 64 GiB, because QEMU takes memory for reserved pages
  // too. If the system refuses, it tries a half, a quarter, ... down to 1 MiB. If the process's
  // address space is limited (ulimit -v), it reserves at most a 64th of the rest. Throws
  // std::bad_alloc if the system grants none. `skew_bytes` (a multiple of 64, below 4096) shifts
  // the first byte, so columns that are walked together do not compete for the same cache sets.
  explicit ReservedMemory(std::size_t bytes, std::size_t skew_bytes = 0);
  // Returns memory and address space to the system.
  ~ReservedMemory();
  // Both exchange the two ranges; pointers into them stay valid.
  ReservedMemory(ReservedMemory&& other) noexcept;
  ReservedMemory& operator=(ReservedMemory&& other) noexcept;

  // Makes at least the first `bytes` usable. Throws std::bad_alloc if the system has no more, or if
  // `bytes` exceeds capacity_bytes().
  void commit(std::size_t bytes) {
    if (bytes > committed_bytes_) grow(bytes);
  }

  // The first byte, 64-byte aligned, null for an empty range; the bytes usable now; the most bytes.
  std::byte* data() const { return data_; }
  std::size_t committed_bytes() const { return committed_bytes_; }
  std::size_t capacity_bytes() const { return capacity_bytes_; }

 private:
  void grow(std::size_t bytes);

  std::byte* data_ = nullptr;
  std::size_t committed_bytes_ = 0;
  std::size_t capacity_bytes_ = 0;
  std::byte* mapping_ = nullptr;
  std::size_t mapping_bytes_ = 0;
};

}  // namespace psygen::ecs::detail
