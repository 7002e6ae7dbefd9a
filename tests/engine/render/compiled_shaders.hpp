// Counts the shaders that llvmpipe compiles in this process: stands in for the function of LLVM
// with which it begins each of them. Only in a program that exports it (tests/engine/render).
#pragma once

#include <cstdint>

namespace psygen::render {

// 0 as long as no device was made, and where no driver uses LLVM.
std::uint64_t compiled_shaders();

}  // namespace psygen::render
