#include "engine/render/software_tuning.hpp"

#include <cstdlib>  // defines __GLIBC__ where there is glibc

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace psygen::render {

void tune_allocator_for_software_rendering() {
#ifdef __GLIBC__
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
  mallopt(M_TOP_PAD, 64 << 20);
  mallopt(M_MMAP_THRESHOLD, 64 << 20);
#endif
}

}  // namespace psygen::render
