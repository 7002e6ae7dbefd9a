#include "ecs/row_bits.hpp"

#include <algorithm>

namespace psygen::ecs::detail {
namespace {

// Calls f(word index, mask) for every word that [first, first + count) touches. The mask has the
// range's bits in that word.
template <class F>
void for_each_word(std::uint32_t first, std::uint32_t count, F&& f) {
  const std::uint32_t end = first + count;
  while (first < end) {
    const std::uint32_t low = first % 64;
    const std::uint32_t length = std::min(64 - low, end - first);
    f(first / 64, (~std::uint64_t{0} >> (64 - length)) << low);
    first += length;
  }
}

}  // namespace

void RowBits::mark_range(std::uint32_t first, std::uint32_t count) {
  if (count == 0) return;
  for_each_word(first, count, [&](std::uint32_t w, std::uint64_t mask) {
    words_[w] |= mask;
    summary_[w / 64] |= bit(w % 64);
  });
  any_ = true;
}

void RowBits::clear_range(std::uint32_t first, std::uint32_t count) {
  for_each_word(first, count, [&](std::uint32_t w, std::uint64_t mask) { words_[w] &= ~mask; });
}

void RowBits::grow(std::size_t count) {
  const std::size_t words = std::max((count + 63) / 64, words_.size() * 2);
  words_.resize(words);
  summary_.resize((words + 63) / 64);
}

}  // namespace psygen::ecs::detail
