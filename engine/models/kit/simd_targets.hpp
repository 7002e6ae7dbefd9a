// Which instruction sets the SIMD kernels of this library are compiled for, and a way to pin one.
// Kernels choose the best set of the CPU at run time (Highway); every set gives the same bits
// (docs/models.md, "Arithmetic"). For tests, which compare the sets, and for measurements, which
// tell how fast each is (`psygen amplify --simd`): the engine calls nothing of this.
#pragma once

#include <string_view>
#include <vector>

namespace psygen::models {

// Sets that this CPU can run, best first: of "avx512", "avx2", "sse4" and, always, "scalar" (on
// processors other than x86-64 the names are Highway's). The same whether one is pinned or not.
std::vector<std::string_view> simd_targets();

// From now on kernels use this set, which must be one of simd_targets(). Not while another thread
// synthesises.
void pin_simd_target(std::string_view name);

// Back to the best set. Not while another thread synthesises.
void unpin_simd_target();

}  // namespace psygen::models
