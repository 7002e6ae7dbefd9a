#include "tests/engine/render/compiled_shaders.hpp"

#include <dlfcn.h>
#include <link.h>

#include <atomic>
#include <cstring>

namespace {

constexpr const char* kBeginModule = "LLVMModuleCreateWithNameInContext";

std::atomic<std::uint64_t> compiled_{0};

using BeginModule = void* (*)(const char* name, void* context);

// That of the LLVM which the driver has loaded. The driver's libraries are not in the program's
// scope, so that RTLD_NEXT does not find them.
BeginModule find_begin_module() {
  void* found = nullptr;
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* out) {
        if (std::strstr(info->dlpi_name, "libLLVM") == nullptr) return 0;
        void* library = dlopen(info->dlpi_name, RTLD_LAZY | RTLD_NOLOAD);
        if (library != nullptr) *static_cast<void**>(out) = dlsym(library, kBeginModule);
        return 1;
      },
      &found);
  return reinterpret_cast<BeginModule>(found);
}

}  // namespace

extern "C" __attribute__((visibility("default"))) void* LLVMModuleCreateWithNameInContext(
    const char* name, void* context);

void* LLVMModuleCreateWithNameInContext(const char* name, void* context) {
  static const BeginModule begin = find_begin_module();
  ++compiled_;
  return begin(name, context);
}

std::uint64_t psygen::render::compiled_shaders() {
  return compiled_;
}
