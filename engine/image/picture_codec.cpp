#include "engine/image/picture_codec.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <sys/mman.h>

#include <array>
#include <atomic>
#include <exception>
#include <latch>
#include <thread>

namespace psygen::image {
namespace {

// What loading takes: measured 101 MB of memory in 325 MB of addresses, and 4 threads.
constexpr std::size_t kMemoryBytes = std::size_t{128} << 20;
constexpr std::size_t kAddressBytes = std::size_t{512} << 20;
constexpr std::size_t kThreads = 8;

bool can_map(std::size_t bytes, int protection) {
  void* memory = mmap(nullptr, bytes, protection, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return false;
  munmap(memory, bytes);
  return true;
}

bool can_start_threads() {
  std::array<std::thread, kThreads> threads;
  std::latch go(1);
  bool all = true;
  try {
    for (std::thread& thread : threads)
      thread = std::thread([&go] { go.wait(); });
  } catch (const std::exception&) {
    all = false;
  }
  go.count_down();
  for (std::thread& thread : threads)
    if (thread.joinable()) thread.join();
  return all;
}

}  // namespace

// The initialisers of these libraries end the program where they do not get what they want: ask for
// as much first.
core::Result<void> check_room_for_codec() {
  if (!can_map(kAddressBytes, PROT_NONE) || !can_map(kMemoryBytes, PROT_READ | PROT_WRITE)) {
    return core::fail(core::ErrorCode::kOutOfMemory,
                      fmt::format("OpenImageIO needs {} MiB of memory", kMemoryBytes >> 20));
  }
  if (can_start_threads()) return {};
  return core::fail(core::ErrorCode::kOutOfMemory,
                    fmt::format("OpenImageIO needs {} threads, which cannot be started", kThreads));
}

core::Result<const PictureCodec*> picture_codec() {
  static std::atomic<const PictureCodec*> loaded{nullptr};
  if (const PictureCodec* codec = loaded.load()) return codec;
  if (auto ok = check_room_for_codec(); !ok) return tl::unexpected(ok.error());
  void* library = dlopen("libpsygen_openimageio.so", RTLD_NOW | RTLD_LOCAL);
  void* codec = library != nullptr ? dlsym(library, "psygen_picture_codec") : nullptr;
  if (codec == nullptr) {
    const char* reason = dlerror();
    return core::fail(core::ErrorCode::kInternal,
                      fmt::format("OpenImageIO cannot be loaded: {}", reason ? reason : "unknown"));
  }
  loaded = static_cast<const PictureCodec*>(codec);
  return loaded.load();
}

}  // namespace psygen::image
