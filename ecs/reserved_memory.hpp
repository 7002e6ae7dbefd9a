// A range of address space that is reserved once and backed by memory as it grows, so that what it
// holds never moves. Fresh memory reads as zero. Large ranges ask for huge pages. Not a container:
// it knows bytes, not objects. Growing costs one system call; touching a page costs its page fault.
#pragma once

#include <cstddef>

namespace psygen::ecs::detail {

class ReservedMemory {
 public:
  ReservedMemory() = default;
  // Reserves `bytes` of address space, or, where the system refuses, the largest half, quarter, ...
  // of it down to 1 MiB; where the process's addresses are limited (ulimit -v), a 64th of those
  // that are left. Throws std::bad_alloc where there is none. `skew_bytes` (a multiple of 64, below
  // 4096) shifts the first byte, so that columns that are walked together do not compete for the
  // same cache sets.
  explicit ReservedMemory(std::size_t bytes, std::size_t skew_bytes = 0);
  ~ReservedMemory();
  ReservedMemory(ReservedMemory&& other) noexcept;
  ReservedMemory& operator=(ReservedMemory&& other) noexcept;

  // Makes at least the first `bytes` usable. Throws std::bad_alloc when the system has no more.
  void commit(std::size_t bytes) {
    if (bytes > committed_bytes_) grow(bytes);
  }

  std::byte* data() const { return data_; }                         // 64-byte aligned
  std::size_t committed_bytes() const { return committed_bytes_; }  // usable now
  std::size_t capacity_bytes() const { return capacity_bytes_; }    // usable at most

 private:
  void grow(std::size_t bytes);

  std::byte* data_ = nullptr;
  std::size_t committed_bytes_ = 0;
  std::size_t capacity_bytes_ = 0;
  std::byte* mapping_ = nullptr;
  std::size_t mapping_bytes_ = 0;
};

}  // namespace psygen::ecs::detail
