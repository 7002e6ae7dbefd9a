// Two programs compared by the instructions that they execute, as callgrind counts them: hardly any
// noise, and no machine needed that is quiet. Says nothing about caches, waiting and devices. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "engine/compare/compare.hpp"

namespace psygen::compare {

// What counts as a change: repeated runs of one program differ by far less.
inline constexpr double kInstructionsShare = 0.01;

struct Instructions {
  std::uint64_t a = 0, b = 0;
  double ratio() const { return static_cast<double>(b) / static_cast<double>(a); }
  // kWorse, kBetter or kSame.
  Verdict verdict() const;
};

// The number in callgrind's output file. Fails with kParse, naming the file, where there is none.
core::Result<std::uint64_t> instructions_in(std::string_view callgrind, const std::string& file);

// What `psygen amplify` printed as the hash of what it made; empty where there is none.
std::string_view hash_in(std::string_view output);

// For people, and compare.json ("psygen.instructions/1").
std::string to_text(const Instructions& instructions);
std::string to_json(const Instructions& instructions);

}  // namespace psygen::compare
