#include "engine/image/picture_codec.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <atomic>

#include "engine/core/headroom.hpp"
#include "engine/core/out_of_memory.hpp"

namespace psygen::image {
namespace {

// Requirements of loading: measured 101 MB of memory in 325 MB of address space, and 4 threads.
constexpr std::uint64_t kMemoryBytes = std::uint64_t{128} << 20;
constexpr std::uint64_t kAddressBytes = std::uint64_t{512} << 20;
constexpr std::size_t kThreads = 6;

}  // namespace

// The initialisers of these libraries terminate the program if they lack memory or threads, so this
// function checks first that both exist.
core::Result<void> check_room_for_codec() {
  if (!core::addresses_left(kAddressBytes) || !core::memory_left(kMemoryBytes)) {
    return core::fail(core::ErrorCode::kOutOfMemory, core::out_of_memory("loading OpenImageIO"));
  }
  if (core::threads_left(kThreads) == kThreads) return {};
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
