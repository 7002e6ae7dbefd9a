#include "engine/visibility/quadtree.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "engine/core/assert.hpp"

namespace psygen::visibility {
namespace {

constexpr double side_of(std::uint8_t level, double block_size_m) {
  return static_cast<double>(std::uint64_t{1} << level) * block_size_m;
}

// The low 32 − level bits of an index, with their sign.
std::int32_t canonical(std::uint32_t index, std::uint8_t level) {
  return static_cast<std::int32_t>(index << level) >> level;
}

// Returns true if [a, a + length_a) and [b, b + length_b) overlap on the ring of block indices.
bool meet(std::int32_t a, std::uint32_t length_a, std::int32_t b, std::uint32_t length_b) {
  const std::uint32_t from_b = static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b);
  return from_b < length_b || 0U - from_b < length_a;
}

bool exists(const BlockArea& world, const NodeCoord& node) {
  const core::BlockCoord corner = corner_block(node);
  const std::uint32_t side = std::uint32_t{1} << node.level;
  return (world.blocks_x == 0 || meet(corner.x, side, world.corner.x, world.blocks_x)) &&
         (world.blocks_z == 0 || meet(corner.z, side, world.corner.z, world.blocks_z));
}

// Along one axis: steps from the first node of a square to its existing nodes.
struct Steps {
  std::int64_t first, last;
};

Steps steps_to_roots(std::int32_t first, std::int32_t last, std::int32_t world_block,
                     std::uint32_t blocks, std::uint8_t level) {
  const auto steps = [first, level](std::int32_t to) {
    return canonical(static_cast<std::uint32_t>(to) - static_cast<std::uint32_t>(first), level);
  };
  const std::int64_t all = steps(last);
  PSYGEN_ASSERT(all >= 0, "the roots must surround the world");
  if (blocks == 0) return {0, all};
  const std::int64_t begin = steps(world_block >> level);
  const std::int64_t nodes =
      ((std::int64_t{world_block} + blocks - 1) >> level) - (world_block >> level) + 1;
  return {std::max<std::int64_t>(begin, 0), std::min(begin + nodes - 1, all)};
}

// Distance of 0 from the interval [low, low + length].
double outside(double low, double length) {
  return std::max({low, -(low + length), 0.0});
}

// 0 at `begin` and before, 1 at `end` and after.
float ramp(double value, double begin, double end) {
  return static_cast<float>(std::clamp((value - begin) / (end - begin), 0.0, 1.0));
}

class Selection {
 public:
  Selection(const CutInput& input, Cut& cut) : in_(input), out_(cut) {
    out_.split_before.swap(out_.split);
    out_.split.clear();
    out_.nodes.clear();
  }

  void run() {
    sort_roots();
    for (const NodeCoord& root : out_.roots)
      add(root, kNoNode, 0);
    std::ranges::sort(out_.split);
  }

 private:
  // Along a half-line from the camera both coordinates of grid cells move away from it. The sum of
  // the two distances in cells therefore never decreases: sorting by it is front to back in every
  // direction.
  void sort_roots() {
    out_.roots.assign(in_.roots.begin(), in_.roots.end());
    if (out_.roots.empty()) return;
    const core::WorldPosition camera = core::normalised(in_.camera, in_.block_size_m);
    const NodeCoord middle = node_of(camera.block, out_.roots.front().level);
    std::ranges::sort(out_.roots, {}, [&middle](const NodeCoord& root) {
      const auto steps = [&](std::int32_t to, std::int32_t from) {
        return std::abs(std::int64_t{canonical(
            static_cast<std::uint32_t>(to) - static_cast<std::uint32_t>(from), root.level)});
      };
      return std::tuple(steps(root.coord.x, middle.coord.x) + steps(root.coord.z, middle.coord.z),
                        root);
    });
  }

  bool is_split(const NodeCoord& node, double distance_m) const {
    const LevelDistances& level = in_.levels[node.level];
    return distance_m < level.split_m ||
           (distance_m < level.merge_m && std::ranges::binary_search(out_.split_before, node));
  }

  void add(const NodeCoord& node, std::uint32_t parent, float morph_to_parent) {
    if (!exists(in_.world, node)) return;
    const glm::dvec3 corner = core::offset_m(corner_block(node), in_.camera, in_.block_size_m);
    const double side = side_of(node.level, in_.block_size_m);
    const double x = outside(corner.x, side), z = outside(corner.z, side);
    const double horizontal_squared = x * x + z * z;
    if (horizontal_squared > in_.view_distance_m * in_.view_distance_m) return;
    const double clearance = in_.clearances_m.empty() ? 0.0 : in_.clearances_m[node.level];
    const double distance = std::sqrt(horizontal_squared + clearance * clearance);
    const bool split = is_split(node, distance);
    if (split) out_.split.push_back(node);

    const auto index = static_cast<std::uint32_t>(out_.nodes.size());
    const LevelDistances& level = in_.levels[node.level];
    const float morph_below = ramp(distance, level.morph_m, level.split_m);
    const bool fine = split && node.level == 0, leaf = !split || fine;
    out_.nodes.push_back({node, leaf, fine, parent, 0, static_cast<float>(corner.x),
                          static_cast<float>(corner.z), static_cast<float>(side),
                          static_cast<float>(distance), fine ? morph_below : morph_to_parent});
    if (!leaf) {
      // The quarter on the camera's side of both centre lines first, the opposite one last.
      const unsigned nearest = (corner.x + side / 2 < 0 ? 1U : 0U) |  //
                               (corner.z + side / 2 < 0 ? 2U : 0U);
      for (unsigned i = 0; i < 4; ++i)
        add(child_of(node, nearest ^ i), index, morph_below);
    }
    out_.nodes[index].end = static_cast<std::uint32_t>(out_.nodes.size());
  }

  const CutInput& in_;
  Cut& out_;
};

// Returns the coarsest level up to which every error is at most `allowed_m`. NaN counts as too
// large.
int coarsest_within(std::span<const float> errors_m, float allowed_m) {
  int level = 0;
  while (level + 1 < static_cast<int>(errors_m.size()) &&
         errors_m[static_cast<std::size_t>(level) + 1] <= allowed_m)
    ++level;
  return level;
}

}  // namespace

NodeCoord neighbour_of(const NodeCoord& node, std::int32_t dx, std::int32_t dz) {
  const auto step = [&node](std::int32_t index, std::int32_t by) {
    return canonical(static_cast<std::uint32_t>(index) + static_cast<std::uint32_t>(by),
                     node.level);
  };
  return {{step(node.coord.x, dx), step(node.coord.z, dz)}, node.level};
}

void split_distances(std::span<const double> level_errors_m, const SplitSettings& settings,
                     std::span<LevelDistances> levels) {
  PSYGEN_ASSERT(level_errors_m.size() == levels.size() && levels.size() <= kMaxNodeLevel + 1U,
                "levels needs one element per error");
  PSYGEN_ASSERT(settings.merge_factor >= 1 && settings.max_error_pixels > 0 &&
                    settings.morph_share > 0 && settings.morph_share <= 1,
                "a setting is out of range");
  // Larger than the rounding errors of distances, so the proof holds for computed numbers.
  constexpr double kBeyondRounding = 1 + 1e-9;
  double merge_below = 0;      // splitting here lets morphing begin beyond the level below
  double reach_below = 0;      // farther than all nodes that touch split nodes of that level
  double reach_two_below = 0;  // the same, two levels below
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const double side = side_of(static_cast<std::uint8_t>(k), settings.block_size_m);
    const double by_error =
        std::min(level_errors_m[k] * settings.pixels_per_radian / settings.max_error_pixels,
                 settings.max_ratio * side);
    const double split =
        std::max({by_error, settings.min_ratio * side, merge_below, reach_two_below});
    // When all are 0, the level is never split and never morphs.
    levels[k] = {split, split * settings.merge_factor, split * settings.morph_share};
    merge_below = levels[k].merge_m / settings.morph_share * kBeyondRounding;
    reach_two_below = reach_below;
    reach_below = (levels[k].merge_m + std::numbers::sqrt2 * side) * kBeyondRounding;
  }
}

void select_cut(const CutInput& input, Cut& cut) {
  Selection(input, cut).run();
}

void roots_around(const core::WorldPosition& camera, double block_size_m, double view_distance_m,
                  std::uint8_t level, std::vector<NodeCoord>& roots, const BlockArea& world) {
  const auto node_at = [&](double reach_m) {
    core::WorldPosition place = camera;
    place.local.x += reach_m;
    place.local.z += reach_m;
    return node_of(core::normalised(place, block_size_m).block, level);
  };
  const NodeCoord first = node_at(-view_distance_m), last = node_at(view_distance_m);
  const Steps x = steps_to_roots(first.coord.x, last.coord.x, world.corner.x, world.blocks_x,
                                 level),
              z = steps_to_roots(first.coord.z, last.coord.z, world.corner.z, world.blocks_z,
                                 level);
  roots.clear();
  for (std::int64_t dz = z.first; dz <= z.last; ++dz) {
    for (std::int64_t dx = x.first; dx <= x.last; ++dx)
      roots.push_back(
          neighbour_of(first, static_cast<std::int32_t>(dx), static_cast<std::int32_t>(dz)));
  }
}

void drawn_nodes(const Cut& cut, std::span<const std::uint8_t> ready,
                 std::vector<std::uint8_t>& scratch, std::vector<std::uint32_t>& drawn) {
  PSYGEN_ASSERT(ready.size() == cut.nodes.size(), "ready needs one element per node");
  // replaced[i]: the ready nodes below node i cover all of it. Children come after their parents.
  std::vector<std::uint8_t>& replaced = scratch;
  replaced.assign(cut.nodes.size(), 1);
  for (std::size_t i = cut.nodes.size(); i-- > 0;) {
    const CutNode& node = cut.nodes[i];
    if (node.leaf) replaced[i] = 0;
    if (replaced[i] == 0 && ready[i] == 0 && node.parent != kNoNode) replaced[node.parent] = 0;
  }
  drawn.clear();
  for (std::uint32_t i = 0; i < cut.nodes.size();) {
    if (replaced[i] == 0 && ready[i] != 0) {
      drawn.push_back(i);
      i = cut.nodes[i].end;
    } else {
      ++i;
    }
  }
}

int choose_level(std::span<const float> level_errors_m, float distance_m, float pixels_per_radian,
                 float max_error_pixels, int current_level) {
  const float allowed_m = max_error_pixels * std::max(distance_m, 0.0F) / pixels_per_radian;
  const int level = coarsest_within(level_errors_m, allowed_m);
  if (current_level < 0 || level <= current_level) return level;
  return std::max(current_level, coarsest_within(level_errors_m, allowed_m * kCoarserShare));
}

}  // namespace psygen::visibility
