// Keeps the Vulkan loader, layer and software driver loaded until the process ends, so that a leak
// checker can name whose leaks it found (tools/lsan.supp names the libraries). Link it into any
// test program that makes a renderer. Does nothing where a library is not installed.
#include <dlfcn.h>

#include <initializer_list>

namespace {

bool keep_drivers_loaded() {
  for (const char* name :
       {"libvulkan.so.1", "libVkLayer_khronos_validation.so", "libvulkan_lvp.so"}) {
    dlopen(name, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  }
  return true;
}

[[maybe_unused]] const bool kKept = keep_drivers_loaded();

}  // namespace
