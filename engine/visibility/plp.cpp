#include "engine/visibility/plp.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "engine/core/assert.hpp"

namespace psygen::visibility {
namespace {

using Entry = PlpResult::Entry;

// Square of the distance from the origin to the box; 0 inside.
float distance_squared(const core::Bounds& box) {
  const auto outside = [](float low, float high) { return std::max(std::max(low, -high), 0.0F); };
  const float x = outside(box.min.x, box.max.x), y = outside(box.min.y, box.max.y),
              z = outside(box.min.z, box.max.z);
  return x * x + y * y + z * z;
}

void sort_few(std::vector<Entry>& entries) {
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.distance_bits != b.distance_bits ? a.distance_bits < b.distance_bits : a.cell < b.cell;
  });
}

// Radix sort by distance. Stable, and digits that all entries share are skipped; entries of equal
// distance are put in order of their cells afterwards.
void sort_by_distance(std::vector<Entry>& entries, std::vector<Entry>& scratch) {
  constexpr std::size_t kFew = 48;
  if (entries.size() < kFew) return sort_few(entries);
  constexpr unsigned kBits = 11, kDigits = 3, kValues = 1U << kBits;
  std::array<std::array<std::uint32_t, kValues>, kDigits> counts{};
  for (const Entry& e : entries) {
    for (unsigned d = 0; d < kDigits; ++d)
      ++counts[d][(e.distance_bits >> (d * kBits)) % kValues];
  }
  scratch.resize(entries.size());
  for (unsigned d = 0; d < kDigits; ++d) {
    const unsigned shift = d * kBits;
    if (counts[d][(entries[0].distance_bits >> shift) % kValues] == entries.size()) continue;
    std::uint32_t sum = 0;
    for (std::uint32_t& count : counts[d])
      sum += std::exchange(count, sum);
    for (const Entry& e : entries)
      scratch[counts[d][(e.distance_bits >> shift) % kValues]++] = e;
    entries.swap(scratch);
  }
  for (auto first = entries.begin(); first != entries.end();) {
    auto last = first + 1;
    while (last != entries.end() && last->distance_bits == first->distance_bits)
      ++last;
    if (last - first > 1)
      std::sort(first, last, [](const Entry& a, const Entry& b) { return a.cell < b.cell; });
    first = last;
  }
}

class Search {
 public:
  Search(const PlpInput& input, PlpResult& result) : in_(input), out_(result) {
    out_.layer.assign(std::size_t{in_.width} * in_.depth, kUnvisited);
    out_.in_view.assign(out_.layer.size(), 0);
    for (auto* list : {&out_.visible, &out_.prefetch, &out_.front})
      list->clear();
    for (auto* list : {&out_.near, &out_.far, &out_.next_near, &out_.next_far})
      list->clear();
  }

  void run() {
    const std::uint32_t x = std::min(in_.start_x, in_.width - 1);
    const std::uint32_t z = std::min(in_.start_z, in_.depth - 1);
    push(z * in_.width + x, 0);
    for (std::uint16_t layer = 0; !out_.next_near.empty() || !out_.next_far.empty(); ++layer) {
      out_.near.swap(out_.next_near);
      out_.far.swap(out_.next_far);
      out_.next_near.clear();
      out_.next_far.clear();
      sort_by_distance(out_.near, out_.scratch);
      sort_by_distance(out_.far, out_.scratch);
      const std::size_t near_visits = visit(out_.near, out_.visible, layer);
      const std::size_t far_visits = visit(out_.far, out_.prefetch, layer);
      if (near_visits < out_.near.size() || far_visits < out_.far.size())
        return stop(near_visits, far_visits);
    }
  }

 private:
  // A clean cell enters the front.
  void push(std::uint32_t cell, std::uint16_t layer) {
    out_.layer[cell] = layer;
    const core::Bounds& box = in_.bounds[cell];
    const bool seen = intersects(*in_.frustum, box);
    out_.in_view[cell] = seen ? 1 : 0;
    const Entry entry{std::bit_cast<std::uint32_t>(distance_squared(box)), cell};
    (seen ? out_.next_near : out_.next_far).push_back(entry);
  }

  void push_neighbours(std::uint32_t cell, std::uint16_t layer) {
    const std::uint32_t x = cell % in_.width, z = cell / in_.width;
    const std::uint32_t x_end = std::min(x + 2, in_.width), z_end = std::min(z + 2, in_.depth);
    for (std::uint32_t nz = z > 0 ? z - 1 : 0; nz < z_end; ++nz) {
      for (std::uint32_t nx = x > 0 ? x - 1 : 0; nx < x_end; ++nx) {
        const std::uint32_t neighbour = nz * in_.width + nx;
        if (out_.layer[neighbour] == kUnvisited) push(neighbour, layer);
      }
    }
  }

  // Takes entries from the front in order, as far as the budget goes. Returns how many.
  std::size_t visit(const std::vector<Entry>& entries, std::vector<std::uint32_t>& list,
                    std::uint16_t layer) {
    const std::size_t count = std::min<std::size_t>(entries.size(), in_.max_visits - visits_);
    visits_ += static_cast<std::uint32_t>(count);
    for (std::size_t i = 0; i < count; ++i) {
      list.push_back(entries[i].cell);
      push_neighbours(entries[i].cell, static_cast<std::uint16_t>(layer + 1));
    }
    return count;
  }

  // The budget has ended: what was pushed and not visited is the front, and clean again.
  void stop(std::size_t near_visits, std::size_t far_visits) {
    sort_by_distance(out_.next_near, out_.scratch);
    sort_by_distance(out_.next_far, out_.scratch);
    const auto keep = [this](const std::vector<Entry>& entries, std::size_t first) {
      for (std::size_t i = first; i < entries.size(); ++i) {
        out_.front.push_back(entries[i].cell);
        out_.layer[entries[i].cell] = kUnvisited;
      }
    };
    keep(out_.near, near_visits);
    keep(out_.far, far_visits);
    keep(out_.next_near, 0);
    keep(out_.next_far, 0);
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
