// Hashes and counter-based random numbers. All are pure functions of their arguments and give the
// same bits on every machine. Not for security. O(1), or O(bytes) for hash_bytes; any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace psygen::core {

// Bijective mixing of 64 bits (the finaliser of SplitMix64; Steele, Lea, Flood 2014).
constexpr std::uint64_t mix64(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ull;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
  return x ^ (x >> 31);
}

// Appends a value to a hash; the order of values matters.
constexpr std::uint64_t combine(std::uint64_t hash, std::uint64_t value) {
  return mix64(hash ^ mix64(value));
}

// XXH3, 64 bits, over the bytes.
std::uint64_t hash_bytes(std::span<const std::byte> bytes, std::uint64_t seed = 0);

// The use of a random number. Two purposes never share a stream.
enum class Purpose : std::uint32_t {
  kPosition = 1,
  kParameters = 2,
  kSeed = 3,
  kStructure = 4,
  kColour = 5,
  kMask = 6
};

// Counter-based generator: the k-th number is hash(world seed, block x, block z, index, purpose,
// k).
class RandomStream {
 public:
  // The stream of element `index` of a block, for one purpose. Starts at k = 0.
  constexpr RandomStream(std::uint64_t world_seed, std::int32_t block_x, std::int32_t block_z,
                         std::uint32_t index, Purpose purpose)
      : key_(combine(
            combine(mix64(world_seed), (std::uint64_t{static_cast<std::uint32_t>(block_x)} << 32) |
                                           static_cast<std::uint32_t>(block_z)),
            (std::uint64_t{index} << 32) | static_cast<std::uint32_t>(purpose))) {}

  // Uniform over all 64-bit numbers.
  constexpr std::uint64_t next_u64() { return mix64(key_ + 0x9E3779B97F4A7C15ull * counter_++); }
  // Uniform in [0, 1), with 53 bits.
  constexpr double next_unit() { return static_cast<double>(next_u64() >> 11) * 0x1.0p-53; }
  // Uniform in [low, high).
  constexpr double next_real(double low, double high) { return low + (high - low) * next_unit(); }
  // Uniform in [low, high], both included. Requires low <= high.
  constexpr std::int64_t next_integer(std::int64_t low, std::int64_t high) {
    const auto range = static_cast<std::uint64_t>(high - low) + 1;
    return low + static_cast<std::int64_t>(range == 0 ? next_u64() : next_u64() % range);
  }

 private:
  std::uint64_t key_;
  std::uint64_t counter_ = 0;
};

}  // namespace psygen::core
