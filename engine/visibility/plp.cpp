#include "engine/visibility/plp.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "engine/core/assert.hpp"

namespace psygen::visibility {
namespace {

std::uint32_t cell_of(std::uint64_t key) {
  return static_cast<std::uint32_t>(key);
}

// Square of the distance from the origin to the box; 0 inside.
float distance_squared(const core::Bounds& box) {
  const auto outside = [](float low, float high) {
    const float beyond = std::max(low, -high);
    return (beyond + std::abs(beyond)) * 0.5F;  // max(beyond, 0) without an unpredictable branch
  };
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

// Distances within a layer are spread evenly. Buckets of equal width, as many as there are keys,
// hold one or two keys each: after filling the buckets little is left to sort.
void sort_keys(std::span<std::uint64_t> keys, std::vector<std::uint64_t>& scratch) {
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
  scratch.assign(keys.begin(), keys.end());
  for (const std::uint64_t key : scratch)
    keys[ends[bucket_of(key)]++] = key;
  if (fullest <= kFew) return insertion_sort(keys);
  std::size_t begin = 0;
  for (const std::uint32_t end : ends) {
    std::sort(keys.data() + begin, keys.data() + end);
    begin = end;
  }
}

class Search {
 public:
  Search(const PlpInput& input, PlpResult& result)
      : in_(input),
        out_(result),
        start_x_(std::min(input.start_x, input.width - 1)),
        start_z_(std::min(input.start_z, input.depth - 1)) {}

  void run() {
    measure_cells();
    find_layers_and_keys();
    deal_into_buckets();
    visit(std::min<std::size_t>(in_.max_visits, cells_));
  }

 private:
  // Computes distances, and tests which cells are in view.
  void measure_cells() {
    out_.in_view.resize(cells_);
    out_.distance_bits.resize(cells_);
    constexpr std::size_t kChunk = 256;  // boxes that stay in the first-level cache
    for (std::size_t first = 0; first < cells_; first += kChunk) {
      const std::size_t count = std::min(kChunk, cells_ - first);
      const auto boxes = in_.bounds.subspan(first, count);
      intersects(*in_.frustum, boxes, std::span(out_.in_view).subspan(first, count));
      for (std::size_t i = 0; i < count; ++i)
        out_.distance_bits[first + i] = std::bit_cast<std::uint32_t>(distance_squared(boxes[i]));
    }
  }

  void find_layers_and_keys() {
    out_.layer.resize(cells_);
    out_.key.resize(cells_);
    for (std::uint32_t z = 0, cell = 0; z < in_.depth; ++z) {
      const std::uint32_t steps_z = z < start_z_ ? start_z_ - z : z - start_z_;
      for (std::uint32_t x = 0; x < in_.width; ++x, ++cell) {
        const std::uint32_t layer = std::max(steps_z, x < start_x_ ? start_x_ - x : x - start_x_);
        out_.layer[cell] = static_cast<std::uint16_t>(layer);
        out_.key[cell] = kKeysPerLayer * layer;
      }
    }
    if (in_.mode == PlpMode::kSolidity) accumulate_solidity();
  }

  // Ring by ring, so the cells before a cell are known. behind[c] first holds what passing through
  // c adds; then the cell's own key is added to it.
  void accumulate_solidity() {
    out_.behind.resize(cells_);
    const float scale = in_.solidity_layers * float{kKeysPerLayer};
    for (std::size_t cell = 0; cell < cells_; ++cell) {
      // NaN counts as 0.
      const float solidity = in_.solidity[cell] > 0 ? std::min(in_.solidity[cell], 1.0F) : 0.0F;
      out_.behind[cell] = kKeysPerLayer + static_cast<std::uint32_t>(
                                              static_cast<std::int32_t>(solidity * scale + 0.5F));
    }
    const std::uint32_t left = start_x_, right = in_.width - 1 - start_x_, up = start_z_,
                        down = in_.depth - 1 - start_z_;
    const auto w = static_cast<std::int32_t>(in_.width);
    const std::uint32_t last = std::max({left, right, up, down});
    std::vector<std::uint32_t>& shares = out_.diagonal_shares;
    for (std::uint32_t layer = 1; layer <= last; ++layer) {
      shares.clear();
      for (std::uint32_t aside = 0; aside <= layer; ++aside)
        shares.push_back((256 * aside + layer / 2) / layer);
      // The left and right sides with the corners, the other two without.
      for (const auto& [ahead, room] : {std::pair{-1, left}, {1, right}}) {
        if (layer > room) continue;
        accumulate(layer, ahead, w, 0, std::min(layer, down));
        accumulate(layer, ahead, -w, 1, std::min(layer, up));
      }
      for (const auto& [ahead, room] : {std::pair{-w, up}, {w, down}}) {
        if (layer > room) continue;
        accumulate(layer, ahead, 1, 0, std::min(layer - 1, right));
        accumulate(layer, ahead, -1, 1, std::min(layer - 1, left));
      }
    }
  }

  // The keys of the cells `layer` steps ahead of the camera's cell and `first` … `last` steps
  // aside. The steps `ahead` and `aside` are differences of indices.
  void accumulate(std::uint32_t layer, std::int32_t ahead, std::int32_t aside, std::uint32_t first,
                  std::uint32_t last) {
    const std::int64_t start = std::int64_t{start_z_} * in_.width + start_x_;
    std::int64_t cell = start + std::int64_t{ahead} * layer + std::int64_t{aside} * first;
    // The cell straight before one cell is diagonally before the next.
    std::uint64_t diagonal = first == 0 ? 0 : out_.behind[at(cell - ahead - aside)];
    for (std::uint32_t steps = first; steps <= last; ++steps, cell += aside) {
      const std::uint64_t straight = out_.behind[at(cell - ahead)], t = out_.diagonal_shares[steps];
      const std::uint64_t key = (straight * (256 - t) + diagonal * t + 128) >> 8;
      out_.key[at(cell)] = static_cast<std::uint32_t>(key);
      out_.behind[at(cell)] += static_cast<std::uint32_t>(key);
      diagonal = straight;
    }
  }

  static std::size_t at(std::int64_t cell) { return static_cast<std::size_t>(cell); }

  // All keys of cells in view, then all of cells out of view.
  std::size_t bucket_of(std::size_t cell) const {
    return out_.key[cell] + (out_.in_view[cell] != 0 ? 0 : keys_);
  }

  void deal_into_buckets() {
    keys_ = std::size_t{*std::ranges::max_element(out_.key)} + 1;
    out_.bucket_ends.assign(2 * keys_, 0);
    for (std::size_t cell = 0; cell < cells_; ++cell)
      ++out_.bucket_ends[bucket_of(cell)];
    std::uint32_t sum = 0;
    for (std::uint32_t& end : out_.bucket_ends)
      sum += std::exchange(end, sum);
    out_.sorted.resize(cells_);
    for (std::size_t cell = 0; cell < cells_; ++cell) {
      out_.sorted[out_.bucket_ends[bucket_of(cell)]++] =
          (std::uint64_t{out_.distance_bits[cell]} << 32) | cell;
    }
    std::size_t begin = 0;
    for (const std::uint32_t end : out_.bucket_ends) {
      if (end - begin > 1)
        sort_keys(std::span(out_.sorted).subspan(begin, end - begin), out_.scratch);
      begin = end;
    }
  }

  void list(std::size_t first, std::size_t last, std::vector<std::uint32_t>& cells) const {
    cells.resize(last - first);
    std::transform(out_.sorted.begin() + static_cast<std::ptrdiff_t>(first),
                   out_.sorted.begin() + static_cast<std::ptrdiff_t>(last), cells.begin(), cell_of);
  }

  // The first `visits` cells leave the front. When the budget ends among cells of one key, those in
  // view come first.
  void visit(std::size_t visits) {
    const std::size_t in_view = out_.bucket_ends[keys_ - 1];
    std::size_t key = 0, near_end = in_view, far_end = cells_;
    if (visits < cells_) {
      while (out_.bucket_ends[key] + (out_.bucket_ends[key + keys_] - in_view) <= visits)
        ++key;
      const std::size_t far_begin = key == 0 ? in_view : out_.bucket_ends[key + keys_ - 1];
      near_end = std::min<std::size_t>(out_.bucket_ends[key], visits - (far_begin - in_view));
      far_end = in_view + visits - near_end;
    }
    list(0, near_end, out_.visible);
    list(in_view, far_end, out_.prefetch);
    out_.front.clear();
    if (visits < cells_) stop(key, near_end, far_end);
  }

  // The budget ended among the cells of `key`. The front is the cells that were not visited but
  // have a visited neighbour.
  void stop(std::size_t key, std::size_t near_begin, std::size_t far_begin) {
    const std::size_t in_view = out_.bucket_ends[keys_ - 1];
    for (std::size_t i = near_begin; i < in_view; ++i)
      out_.layer[cell_of(out_.sorted[i])] = kUnvisited;
    for (std::size_t i = far_begin; i < cells_; ++i)
      out_.layer[cell_of(out_.sorted[i])] = kUnvisited;
    const bool nothing_visited = near_begin == 0 && far_begin == in_view;
    const auto keep = [&](std::size_t& begin, std::size_t end) {
      for (; begin < end; ++begin) {
        const std::uint32_t cell = cell_of(out_.sorted[begin]);
        if (has_visited_neighbour(cell) || (nothing_visited && out_.key[cell] == 0))
          out_.front.push_back(cell);
      }
    };
    for (; key < keys_; ++key) {
      keep(near_begin, out_.bucket_ends[key]);
      keep(far_begin, out_.bucket_ends[key + keys_]);
    }
  }

  bool has_visited_neighbour(std::uint32_t cell) const {
    const std::uint32_t x = cell % in_.width, z = cell / in_.width;
    const std::uint32_t x_end = std::min(x + 2, in_.width), z_end = std::min(z + 2, in_.depth);
    for (std::uint32_t nz = z > 0 ? z - 1 : 0; nz < z_end; ++nz) {
      for (std::uint32_t nx = x > 0 ? x - 1 : 0; nx < x_end; ++nx) {
        if (out_.layer[nz * in_.width + nx] != kUnvisited) return true;
      }
    }
    return false;
  }

  const PlpInput& in_;
  PlpResult& out_;
  const std::uint32_t start_x_, start_z_;
  const std::size_t cells_ = in_.bounds.size();
  std::size_t keys_ = 0;  // the largest key plus one
};

}  // namespace

void run_plp(const PlpInput& input, PlpResult& result) {
  PSYGEN_ASSERT(input.bounds.size() == std::size_t{input.width} * input.depth,
                "bounds needs one box per cell");
  PSYGEN_ASSERT(input.width < kUnvisited && input.depth < kUnvisited,
                "the grid is too large for 16-bit layers");
  PSYGEN_ASSERT(input.mode == PlpMode::kLayers || input.solidity.size() == input.bounds.size(),
                "solidity needs one value per cell");
  PSYGEN_ASSERT(input.solidity_layers >= 0 && input.solidity_layers <= 64,
                "solidity_layers is out of range");
  if (!input.bounds.empty()) return Search(input, result).run();
  result.layer.clear();
  result.key.clear();
  result.in_view.clear();
  for (auto* cells : {&result.visible, &result.prefetch, &result.front})
    cells->clear();
}

}  // namespace psygen::visibility
