#include "engine/models/kit/scratch.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace psygen::models {
namespace {

constexpr std::size_t kLeast = 1 << 16;
constexpr std::size_t kSizes =
    std::bit_width(ScratchMemory::kLargestKept) - std::bit_width(kLeast) + 1;

void release(void* memory) {
  ::operator delete(memory, std::align_val_t(ScratchMemory::kAlignment));
}

// Blocks that this thread keeps, by size. Without constructor and destructor, so that access is
// cheap.
using Blocks = std::array<void*, 2>;
constinit thread_local std::array<Blocks, kSizes> kept{};
constinit thread_local bool has_ended = false;  // the thread keeps nothing any more

// Frees the blocks at the end of the thread.
struct Keeper {
  bool begun = false;
  ~Keeper() {
    for (const Blocks& same : kept)
      std::ranges::for_each(same, release);
    has_ended = true;
  }
};
thread_local Keeper keeper;

// The blocks of this size; null: no such blocks are kept.
Blocks* blocks_of(std::size_t bytes) {
  if (bytes > ScratchMemory::kLargestKept || has_ended) return nullptr;
  return &kept[static_cast<std::size_t>(std::bit_width(bytes) - std::bit_width(kLeast))];
}

}  // namespace

ScratchMemory::ScratchMemory(std::size_t bytes)
    : bytes_(std::bit_ceil(std::max(bytes, kLeast))), memory_(nullptr) {
  if (Blocks* const blocks = blocks_of(bytes_)) {
    auto& [first, second] = *blocks;
    memory_ = std::exchange(first != nullptr ? first : second, nullptr);
  }
  if (memory_ != nullptr) return;
  memory_ = ::operator new(bytes_, std::align_val_t(kAlignment));
}

ScratchMemory::~ScratchMemory() {
  if (memory_ == nullptr) return;
  if (Blocks* const blocks = blocks_of(bytes_)) {
    auto& [first, second] = *blocks;
    void*& place = first == nullptr ? first : second;
    if (place == nullptr) {
      keeper.begun = true;  // also in a thread that only ends leases
      place = memory_;
      return;
    }
  }
  release(memory_);
}

}  // namespace psygen::models
