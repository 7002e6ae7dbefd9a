#include "engine/visibility/plp.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "engine/core/assert.hpp"

namespace psygen::visibility {
namespace {

using Keys = PlpResult::Keys;

std::uint32_t cell_of(std::uint64_t key) {
  return static_cast<std::uint32_t>(key);
}

// Square of the distance from the origin to the box; 0 inside.
float distance_squared(const core::Bounds& box) {
  const auto outside = [](float low, float high) { return std::max(std::max(low, -high), 0.0F); };
  const float x = outside(box.min.x, box.max.x), y = outside(box.min.y, box.max.y),
              z = outside(box.min.z, box.max.z);
  return x * x + y * y + z * z;
}

void insertion_sort(std::span<std::uint64_t> keys) {
  for (std::size_t i = 1; i < keys.size(); ++i) {
    const std::uint64_t key = keys[i];
    std::size_t hole = i;
    for (; hole > 0 && keys[hole - 1] > key; --hole)
      keys[hole] = keys[hole - 1];
    keys[hole] = key;
  }
}

// The distances within a layer are spread so evenly that buckets of equal width, as many as there
// are keys, hold one or two each: after dealing them out little is left to sort.
void sort_keys(Keys& keys, Keys& scratch) {
  constexpr std::size_t kMaxBuckets = 1024, kFew = 24;
  if (keys.size() < kFew) return insertion_sort(keys);
  std::uint64_t low = keys[0], high = keys[0];
  for (const std::uint64_t key : keys) {
    low = std::min(low, key);
    high = std::max(high, key);
  }
  const std::size_t buckets = std::min(std::bit_ceil(keys.size()), kMaxBuckets);
  const std::uint64_t range = (high >> 32) - (low >> 32) + 1;
  const std::uint64_t scale = (std::uint64_t{buckets} << 32) / range;  // 32 fractional bits
  const auto bucket_of = [&](std::uint64_t key) {
    return static_cast<std::size_t>(((key >> 32) - (low >> 32)) * scale >> 32);
  };
  std::array<std::uint32_t, kMaxBuckets> storage;
  const std::span ends = std::span(storage).first(buckets);
  std::ranges::fill(ends, 0U);
  for (const std::uint64_t key : keys)
    ++ends[bucket_of(key)];
  std::uint32_t sum = 0, fullest = 0;
  for (std::uint32_t& end : ends) {
    fullest = std::max(fullest, end);
    sum += std::exchange(end, sum);
  }
  scratch.resize(keys.size());
  for (const std::uint64_t key : keys)
    scratch[ends[bucket_of(key)]++] = key;
  keys.swap(scratch);
  if (fullest <= kFew) return insertion_sort(keys);
  std::size_t begin = 0;
  for (const std::uint32_t end : ends) {
    std::sort(keys.data() + begin, keys.data() + end);
    begin = end;
  }
}

class Search {
 public:
  Search(const PlpInput& input, PlpResult& result) : in_(input), out_(result) {
    const std::size_t cells = std::size_t{in_.width} * in_.depth;
    out_.layer.assign(cells, kUnvisited);
    out_.in_view.resize(cells);
    out_.distance_bits.resize(cells);
    constexpr std::size_t kChunk = 256;  // of boxes that stay in the first-level cache
    for (std::size_t first = 0; first < cells; first += kChunk) {
      const std::size_t count = std::min(kChunk, cells - first);
      const auto boxes = in_.bounds.subspan(first, count);
      intersects(*in_.frustum, boxes, std::span(out_.in_view).subspan(first, count));
      for (std::size_t i = 0; i < count; ++i)
        out_.distance_bits[first + i] = std::bit_cast<std::uint32_t>(distance_squared(boxes[i]));
    }
    for (auto* list : {&out_.visible, &out_.prefetch, &out_.front})
      list->clear();
    for (auto* lists : {&out_.current, &out_.next}) {
      for (auto& list : *lists)
        list.clear();
    }
  }

  void run() {
    const std::uint32_t x = std::min(in_.start_x, in_.width - 1);
    const std::uint32_t z = std::min(in_.start_z, in_.depth - 1);
    push(z * in_.width + x, 0);
    for (std::uint16_t layer = 0; !out_.next[0].empty() || !out_.next[1].empty(); ++layer) {
      out_.current.swap(out_.next);
      for (std::size_t view = 0; view < 2; ++view) {
        out_.next[view].clear();
        sort_keys(out_.current[view], out_.scratch);
      }
      const std::size_t near_visits = visit(out_.current[1], out_.visible, layer);
      const std::size_t far_visits = visit(out_.current[0], out_.prefetch, layer);
      if (near_visits < out_.current[1].size() || far_visits < out_.current[0].size())
        return stop(near_visits, far_visits);
    }
  }

 private:
  // A clean cell enters the front.
  void push(std::uint32_t cell, std::uint16_t layer) {
    out_.layer[cell] = layer;
    out_.next[out_.in_view[cell]].push_back((std::uint64_t{out_.distance_bits[cell]} << 32) | cell);
  }

  void push_neighbours(std::uint32_t cell, std::uint16_t layer) {
    const std::uint32_t w = in_.width, x = cell % w, z = cell / w;
    if (x == 0 || z == 0 || x + 1 == w || z + 1 == in_.depth)
      return push_border_neighbours(x, z, layer);
    // Most neighbours are not clean, and which ones are is hard to guess for a branch.
    const std::uint32_t around[8] = {cell - w - 1, cell - w,     cell - w + 1, cell - 1,
                                     cell + 1,     cell + w - 1, cell + w,     cell + w + 1};
    unsigned clean = 0;
    for (unsigned i = 0; i < 8; ++i)
      clean |= (out_.layer[around[i]] == kUnvisited ? 1U : 0U) << i;
    for (; clean != 0; clean &= clean - 1)
      push(around[std::countr_zero(clean)], layer);
  }

  void push_border_neighbours(std::uint32_t x, std::uint32_t z, std::uint16_t layer) {
    const std::uint32_t x_end = std::min(x + 2, in_.width), z_end = std::min(z + 2, in_.depth);
    for (std::uint32_t nz = z > 0 ? z - 1 : 0; nz < z_end; ++nz) {
      for (std::uint32_t nx = x > 0 ? x - 1 : 0; nx < x_end; ++nx) {
        const std::uint32_t neighbour = nz * in_.width + nx;
        if (out_.layer[neighbour] == kUnvisited) push(neighbour, layer);
      }
    }
  }

  // Takes cells from the front in order, as far as the budget goes. Returns how many.
  std::size_t visit(const Keys& keys, std::vector<std::uint32_t>& list, std::uint16_t layer) {
    const std::size_t count = std::min<std::size_t>(keys.size(), in_.max_visits - visits_);
    visits_ += static_cast<std::uint32_t>(count);
    for (std::size_t i = 0; i < count; ++i) {
      list.push_back(cell_of(keys[i]));
      push_neighbours(cell_of(keys[i]), static_cast<std::uint16_t>(layer + 1));
    }
    return count;
  }

  // The budget has ended: what was pushed and not visited is the front, and clean again.
  void stop(std::size_t near_visits, std::size_t far_visits) {
    const auto keep = [this](const Keys& keys, std::size_t first) {
      for (std::size_t i = first; i < keys.size(); ++i) {
        out_.front.push_back(cell_of(keys[i]));
        out_.layer[cell_of(keys[i])] = kUnvisited;
      }
    };
    keep(out_.current[1], near_visits);
    keep(out_.current[0], far_visits);
    for (const std::size_t view : {1U, 0U}) {
      sort_keys(out_.next[view], out_.scratch);
      keep(out_.next[view], 0);
    }
  }

  const PlpInput& in_;
  PlpResult& out_;
  std::uint32_t visits_ = 0;
};

std::uint32_t clamp_to_axis(std::int32_t corner, std::uint32_t length, std::int32_t block) {
  // Differences wrap, so that grids across the seam of the block indices work.
  const auto offset = static_cast<std::int32_t>(static_cast<std::uint32_t>(block) -
                                                static_cast<std::uint32_t>(corner));
  return offset < 0 ? 0 : std::min(static_cast<std::uint32_t>(offset), length - 1);
}

}  // namespace

void run_plp(const PlpInput& input, PlpResult& result) {
  PSYGEN_ASSERT(input.bounds.size() == std::size_t{input.width} * input.depth,
                "there is one box for each cell");
  PSYGEN_ASSERT(input.width < kUnvisited && input.depth < kUnvisited, "layers fit 16 bits");
  Search search(input, result);
  if (!input.bounds.empty()) search.run();
}

GridCell nearest_cell(core::BlockCoord corner, std::uint32_t width, std::uint32_t depth,
                      core::BlockCoord block) {
  PSYGEN_ASSERT(width > 0 && depth > 0, "the grid has a cell");
  return {clamp_to_axis(corner.x, width, block.x), clamp_to_axis(corner.z, depth, block.z)};
}

}  // namespace psygen::visibility
