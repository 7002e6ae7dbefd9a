// Settings of the process that suit a software rasteriser. For programs, not for libraries: call
// them first in main or before a renderer is made, while there are no other threads.
#pragma once

#include "engine/core/error.hpp"

namespace psygen::render {

// A software rasteriser allocates and frees its bins every frame: the C library keeps freed memory
// instead of giving it back to the kernel page by page. Where the process's memory is limited
// (ulimit -d, ulimit -v) nothing is kept. Does nothing where the C library is not glibc.
void tune_allocator_for_software_rendering();

// llvmpipe waits for ever for threads of its own that it could not start. Where the system does not
// give them all (ulimit -u, limits of containers) it is told to start fewer (LP_NUM_THREADS, unless
// that is set). Fails with kInternal where drawing would get none.
core::Result<void> fit_software_rendering_to_threads();

}  // namespace psygen::render
