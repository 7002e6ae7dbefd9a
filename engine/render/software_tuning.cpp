#include "engine/render/software_tuning.hpp"

#include <cstdint>
#include <cstdlib>  // defines __GLIBC__ where there is glibc

#ifdef __GLIBC__
#include <malloc.h>
#endif
#ifdef __linux__
#include <sys/mman.h>
#endif

namespace psygen::render {

void tune_allocator_for_software_rendering() {
#ifdef __GLIBC__
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
  mallopt(M_TOP_PAD, 64 << 20);
  mallopt(M_MMAP_THRESHOLD, 64 << 20);
#endif
}

void prefer_huge_pages([[maybe_unused]] std::span<std::byte> memory) {
#ifdef __linux__
  constexpr std::uintptr_t kHugePage = 2u << 20;
  const auto first = reinterpret_cast<std::uintptr_t>(memory.data());
  const std::uintptr_t begin = (first + kHugePage - 1) / kHugePage * kHugePage;
  const std::uintptr_t end = (first + memory.size()) / kHugePage * kHugePage;
  if (begin < end) (void)madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
#endif
}

}  // namespace psygen::render
