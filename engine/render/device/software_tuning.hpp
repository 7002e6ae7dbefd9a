// Settings of the process and the kernel for software rasterisers, where the CPU both writes and
// reads the geometry. They affect only speed and stability, not the picture.
#pragma once

#include <cstddef>
#include <span>

#include "engine/core/error.hpp"

namespace psygen::render {

// Asks the kernel for pages of 2 MiB under fresh memory. The first access to a page costs a fault,
// about 3 µs on a virtual machine, and the mesh of a tree has thirty small pages. Does nothing if
// the kernel has no such pages, for device memory, and for memory smaller than such a page.
void prefer_huge_pages(std::span<std::byte> memory);

// app::Session calls it before it creates a renderer. llvmpipe starts a thread for each processor
// of its affinity. It knows no quotas, and waits forever for threads that it could not start. So
// this makes it start fewer (LP_NUM_THREADS, unless that is set) if a quota grants less time, or if
// the system refuses threads (ulimit -u, limits of containers). Returns the number of threads that
// llvmpipe will start; with 0 it draws in the thread of its queue. Fails with kInternal if there
// would be no thread for drawing.
core::Result<std::size_t> fit_software_rendering();

}  // namespace psygen::render
