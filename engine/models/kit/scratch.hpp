// Working memory for values that are too large for a small stack. Threads keep what they give back,
// so a lease costs some nanoseconds. Model types, queries and amplification need 144 KiB of stack
// with it (measured on x86-64, caller included), and 1.1 MiB without. Any thread; a lease may end
// on another thread than it began on.
#pragma once

#include <cstddef>
#include <new>
#include <utility>

namespace psygen::models {

// Uninitialised bytes at a multiple of kAlignment. Throws std::bad_alloc.
class ScratchMemory {
 public:
  static constexpr std::size_t kAlignment = 64;
  // Threads keep up to two blocks of each power of two from 64 KiB to this size.
  static constexpr std::size_t kLargestKept = 1 << 20;

  // Takes a kept block, or allocates one.
  explicit ScratchMemory(std::size_t bytes);
  ~ScratchMemory();
  ScratchMemory(ScratchMemory&& other) noexcept
      : bytes_(other.bytes_), memory_(std::exchange(other.memory_, nullptr)) {}
  ScratchMemory& operator=(ScratchMemory&& other) noexcept {
    std::swap(bytes_, other.bytes_);
    std::swap(memory_, other.memory_);
    return *this;
  }

  // Its first byte.
  void* get() const { return memory_; }

 private:
  std::size_t bytes_;
  void* memory_;
};

// A value in such memory, as if it stood in its place: constructed anew each time, and without
// arguments default-initialised.
template <class T>
class Scratch {
 public:
  template <class... Args>
  explicit Scratch(Args&&... args) : memory_(sizeof(T)) {
    static_assert(alignof(T) <= ScratchMemory::kAlignment);
    if constexpr (sizeof...(Args) == 0) {
      value_ = ::new (memory_.get()) T;
    } else {
      value_ = ::new (memory_.get()) T(std::forward<Args>(args)...);
    }
  }
  ~Scratch() { value_->~T(); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  T& operator*() const { return *value_; }
  T* operator->() const { return value_; }

 private:
  ScratchMemory memory_;
  T* value_;
};

}  // namespace psygen::models
