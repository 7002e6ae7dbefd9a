#include "ecs/reserved_memory.hpp"

#include <algorithm>
#include <cstdint>
#include <new>
#include <utility>

#include "ecs/address_space.hpp"
#include "ecs/check.hpp"

namespace psygen::ecs::detail {
namespace {

constexpr std::size_t kHugePageBytes = std::size_t{2} << 20;
constexpr std::size_t kSmallestStepBytes = std::size_t{64} << 10;
constexpr std::size_t kSmallestReservationBytes = std::size_t{1} << 20;
constexpr std::size_t kLargestReservationBytes = std::size_t{64} << 30;
// Of limited address space a reservation takes a small part, which leaves enough for others and the
// rest of the program.
constexpr std::size_t kPart = 64;

constexpr std::size_t round_up(std::size_t value, std::size_t step) {
  return (value + step - 1) / step * step;
}

}  // namespace

ReservedMemory::ReservedMemory(std::size_t bytes, std::size_t skew_bytes) {
  PSYGEN_ECS_ASSERT(skew_bytes % 64 == 0 && skew_bytes < 4096, "skew is 0, 64, ... 4032");
  const std::size_t most = std::min(kLargestReservationBytes, address_space_left() / kPart);
  std::size_t wanted = std::max(std::min(bytes, most), kSmallestReservationBytes);
  for (; mapping_ == nullptr && wanted >= kSmallestReservationBytes; wanted /= 2) {
    mapping_bytes_ = round_up(wanted + skew_bytes, kHugePageBytes) + kHugePageBytes;
    mapping_ = static_cast<std::byte*>(reserve_address_space(mapping_bytes_));
  }
  if (mapping_ == nullptr) throw std::bad_alloc();
  const auto address = reinterpret_cast<std::uintptr_t>(mapping_);
  const std::size_t lead = round_up(address, kHugePageBytes) - address;
  data_ = mapping_ + lead + skew_bytes;
  capacity_bytes_ = mapping_bytes_ - lead - skew_bytes;
}

ReservedMemory::~ReservedMemory() {
  if (mapping_ != nullptr) release_address_space(mapping_, mapping_bytes_);
}

ReservedMemory::ReservedMemory(ReservedMemory&& other) noexcept {
  *this = std::move(other);
}

ReservedMemory& ReservedMemory::operator=(ReservedMemory&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(committed_bytes_, other.committed_bytes_);
  std::swap(capacity_bytes_, other.capacity_bytes_);
  std::swap(mapping_, other.mapping_);
  std::swap(mapping_bytes_, other.mapping_bytes_);
  return *this;
}

void ReservedMemory::grow(std::size_t bytes) {
  if (bytes > capacity_bytes_) throw std::bad_alloc();
  const std::size_t step = bytes >= kHugePageBytes ? kHugePageBytes : kSmallestStepBytes;
  const std::size_t skew_bytes = reinterpret_cast<std::uintptr_t>(data_) % kHugePageBytes;
  std::byte* base = data_ - skew_bytes;
  const std::size_t usable = round_up(bytes + skew_bytes, step);
  const std::size_t clamped = std::min(usable, capacity_bytes_ + skew_bytes);
  if (!commit_pages(base, clamped)) throw std::bad_alloc();
  committed_bytes_ = clamped - skew_bytes;
}

}  // namespace psygen::ecs::detail
