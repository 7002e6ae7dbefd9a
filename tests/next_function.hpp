// For what replaces functions of the C library in a whole program: the replaced ones.
#pragma once

#include <dlfcn.h>

namespace psygen {

// The function of this name that would have been called: the C library's, or a sanitizer's.
template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace psygen
