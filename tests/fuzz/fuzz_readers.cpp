// Runs libFuzzer on all readers of user files (tools/fuzz.sh).
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "tests/fuzz/mutator.hpp"
#include "tests/fuzz/reading.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

std::string text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static psygen::fuzz::FileInMemory file;
  psygen::fuzz::read_as_everything(text_of(data, size), file);
  return 0;
}

// Half of the texts come from libFuzzer, which traces the comparisons of the program. A few start
// from examples of features that no shipped file uses.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  static const std::vector<std::string> examples{
      psygen::fuzz::example_bindings(), psygen::fuzz::example_frame_test(),
      psygen::fuzz::example_recording(), psygen::fuzz::example_edits(),
      psygen::fuzz::example_gltf()};
  static std::vector<std::string> others(1);
  std::mt19937_64 random(seed);
  if (random() % 2 == 0) return LLVMFuzzerMutate(data, size, most);
  const std::string before =
      random() % 16 == 0 ? examples[random() % examples.size()] : text_of(data, size);
  const std::string after = psygen::fuzz::mutated(before, others, most, random);
  constexpr std::size_t kMaxOthers = 64;  // recent texts
  if (others.size() < kMaxOthers) others.push_back(before);
  others[random() % others.size()] = before;
  std::memcpy(data, after.data(), after.size());
  return after.size();
}
