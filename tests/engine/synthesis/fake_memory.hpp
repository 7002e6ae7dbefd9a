// Geometry memory for tests: releases bytes only after some frames, as a GPU does, and fails to
// reserve on demand.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>

#include "engine/core/geometry_memory.hpp"

namespace psygen::synthesis::testing {

class FakeMemory final : public core::GeometryMemory {
 public:
  FakeMemory(std::uint64_t capacity_bytes, int frames_in_flight)
      : heap_(capacity_bytes), frames_in_flight_(frames_in_flight) {}

  void fail_next_reservations(int count) { failures_ = count; }
  // Limits the capacity that it reports from now on.
  void limit_capacity(std::uint64_t bytes) { capacity_bytes_ = bytes; }
  void end_frame() {
    for (Pending& p : pending_)
      --p.frames;
    while (!pending_.empty() && pending_.front().frames <= 0) {
      heap_.release(pending_.front().range);
      pending_.pop_front();
    }
  }

  core::Result<core::GeometryReservation> reserve(core::VertexLayout layout, std::uint32_t vertices,
                                                  std::uint32_t indices) override {
    if (failures_ > 0) {
      --failures_;
      return core::fail(core::ErrorCode::kOutOfMemory, "the test asked for a failure");
    }
    return heap_.reserve(layout, vertices, indices);
  }
  void commit(const core::GeometryRange& range) override { heap_.commit(range); }
  void release(const core::GeometryRange& range) override {
    if (frames_in_flight_ == 0) return heap_.release(range);
    pending_.push_back({range, frames_in_flight_});
  }
  std::uint32_t charged_bytes(core::VertexLayout layout, std::uint32_t vertices,
                              std::uint32_t indices) const override {
    return heap_.charged_bytes(layout, vertices, indices);
  }
  std::uint64_t used_bytes() const override { return heap_.used_bytes(); }
  std::uint64_t capacity_bytes() const override {
    return std::min(capacity_bytes_, heap_.capacity_bytes());
  }
  bool zero_copy() const override { return true; }
  std::span<const std::byte> vertex_bytes(const core::GeometryRange& range) const override {
    return heap_.vertex_bytes(range);
  }
  std::span<const std::uint16_t> indices(const core::GeometryRange& range) const override {
    return heap_.indices(range);
  }

 private:
  struct Pending {
    core::GeometryRange range;
    int frames;
  };
  core::HeapGeometryMemory heap_;
  int frames_in_flight_;
  int failures_ = 0;
  std::uint64_t capacity_bytes_ = UINT64_MAX;
  std::deque<Pending> pending_;
};

}  // namespace psygen::synthesis::testing
