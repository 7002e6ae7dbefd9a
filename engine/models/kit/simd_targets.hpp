// The compiled instruction sets of this library's SIMD kernels, and a way to pin one. Kernels
// select the best set of the CPU at run time (Highway). Every set gives the same bits
// (docs/models.md, "Arithmetic"). For tests, which compare the sets, and for measurements of each
// set (`psygen amplify --simd`). The engine itself uses none of this.
#pragma once

#include <string_view>
#include <vector>

namespace psygen::models {

// Returns the sets that this CPU can run, best first: some of "avx512", "avx2" and "sse4", and
// always "scalar". On processors other than x86-64 the names are Highway's. Pinning does not change
// the list.
std::vector<std::string_view> simd_targets();

// Makes all later kernel calls use this set. `name` must be one of simd_targets(), which is
// checked. Not to be called while another thread synthesises.
void pin_simd_target(std::string_view name);

// Returns to the best set. Not to be called while another thread synthesises.
void unpin_simd_target();

}  // namespace psygen::models
