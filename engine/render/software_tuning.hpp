// Settings of the process, its C library and the kernel that suit a software rasteriser, whose
// geometry the processor itself writes and reads. Nothing here changes what is drawn.
#pragma once

#include <cstddef>
#include <span>

#include "engine/core/error.hpp"

namespace psygen::render {

// Call first in main, before other threads exist. A software rasteriser allocates and frees its
// bins every frame: the C library keeps freed memory instead of giving it back to the kernel page
// by page. Where the process's memory is limited (ulimit -d, ulimit -v) nothing is kept. Does
// nothing where the C library is not glibc.
void tune_allocator_for_software_rendering();

// Asks the kernel for pages of 2 MiB under fresh memory: a first touch costs a fault, some 3 µs on
// a virtual machine, and a mesh of a tree touches thirty small pages. Does nothing where the kernel
// has none, for memory of a device, and for less than such a page.
void prefer_huge_pages(std::span<std::byte> memory);

// For programs, before a renderer is made. llvmpipe waits for ever for threads of its own that it
// could not start. Where the system does not give them all (ulimit -u, limits of containers) it is
// told to start fewer (LP_NUM_THREADS, unless that is set). Fails with kInternal where drawing
// would get none.
core::Result<void> fit_software_rendering_to_threads();

}  // namespace psygen::render
