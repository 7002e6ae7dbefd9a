// Compares two programs by their executed instructions, counted by callgrind: almost free of noise,
// even on a busy machine. Ignores caches, waiting and GPUs. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "engine/compare/compare.hpp"

namespace psygen::compare {

// Smallest relative change: repeated runs of one program differ by far less.
inline constexpr double kInstructionsShare = 0.01;

struct Instructions {
  std::uint64_t a = 0, b = 0;
  double ratio() const { return static_cast<double>(b) / static_cast<double>(a); }
  // kWorse, kBetter or kSame.
  Verdict verdict() const;
};

// Reads the instruction count from callgrind's output file. Fails with kParse, naming the file, if
// it has none.
core::Result<std::uint64_t> instructions_in(std::string_view callgrind, const std::string& file);

// The hash in the output of `psygen amplify`; empty if there is none.
std::string_view hash_in(std::string_view output);

// Text for the terminal, and compare.json ("psygen.instructions/1").
std::string to_text(const Instructions& instructions);
std::string to_json(const Instructions& instructions);

}  // namespace psygen::compare
