#include "engine/render/device/software_tuning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "engine/core/headroom.hpp"
#include "engine/core/processors.hpp"

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace psygen::render {
namespace {

// llvmpipe starts one thread per processor, at most this many.
constexpr std::size_t kMaxRasterThreads = 32;
// Other threads: the driver's queue and a modeler, without which there is no picture, and two
// threads of the driver's shader cache.
constexpr std::size_t kMinThreads = 2, kOtherThreads = 4;
constexpr const char* kThreadsVariable = "LP_NUM_THREADS";

}  // namespace

void prefer_huge_pages([[maybe_unused]] std::span<std::byte> memory) {
#ifdef __linux__
  constexpr std::uintptr_t kHugePage = 2u << 20;
  const auto first = reinterpret_cast<std::uintptr_t>(memory.data());
  const std::uintptr_t begin = (first + kHugePage - 1) / kHugePage * kHugePage;
  const std::uintptr_t end = (first + memory.size()) / kHugePage * kHugePage;
  if (begin < end) (void)madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
#endif
}

core::Result<std::size_t> fit_software_rendering() {
  const std::size_t allowed = core::allowed_processors(), usable = core::usable_processors();
  // With one processor llvmpipe draws in the thread of its queue, unless it is told otherwise.
  const std::size_t wanted = (usable > 1 ? std::min(usable, kMaxRasterThreads) : 0) + kOtherThreads;
  const std::size_t left = core::threads_left(wanted);
  if (left < kMinThreads) {
    return core::fail(core::ErrorCode::kInternal,
                      fmt::format("drawing needs at least {} threads; the system allows {} more",
                                  kMinThreads, left));
  }
  const std::size_t raster = left - std::min(left, kOtherThreads);
  const char* const set = std::getenv(kThreadsVariable);
  if (set != nullptr) return std::strtoul(set, nullptr, 10);
  if (raster < allowed) setenv(kThreadsVariable, std::to_string(raster).c_str(), /*overwrite=*/0);
  return raster;
}

}  // namespace psygen::render
