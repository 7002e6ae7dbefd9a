// Settings of the C library and the kernel that suit a software rasteriser, whose geometry the
// processor itself writes and reads. Nothing here changes what is drawn.
#pragma once

#include <cstddef>
#include <span>

namespace psygen::render {

// Call first in main, before other threads exist. Keeps freed memory instead of giving it back to
// the kernel page by page: a rasteriser allocates and frees its bins every frame. Does nothing
// where the C library is not glibc.
void tune_allocator_for_software_rendering();

// Asks the kernel for pages of 2 MiB under fresh memory: a first touch costs a fault, some 3 µs on
// a virtual machine, and a mesh of a tree touches thirty small pages. Does nothing where the kernel
// has none, for memory of a device, and for less than such a page.
void prefer_huge_pages(std::span<std::byte> memory);

}  // namespace psygen::render
