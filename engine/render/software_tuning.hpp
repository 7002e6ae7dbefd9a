// Settings of the C library's allocator that suit a software rasteriser, which allocates and frees
// its bins every frame: keep freed memory instead of giving it back to the kernel page by page.
#pragma once

namespace psygen::render {

// Call first in main, before other threads exist. Does nothing where the C library is not glibc.
void tune_allocator_for_software_rendering();

}  // namespace psygen::render
