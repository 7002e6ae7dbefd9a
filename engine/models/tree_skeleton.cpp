#include "engine/models/tree_skeleton.hpp"

#include "engine/models/tree.hpp"
#include "engine/models/tree_math.hpp"

namespace psygen::models {
namespace {

constexpr std::uint64_t kRootSalt = 0x5472656553656564ull;
constexpr std::uint64_t kLooksSalt = 0xA24BAED4963EE407ull;
constexpr float kGoldenTurns = 0.381966011F;

float tip_or(bool tip, float radius, float taper) {
  return tip ? 0.0F : radius * taper;
}

// What is left of a branch that would end at `end`: all inside the envelope, less further out.
float kept_share(const TreeShape& s, const glm::vec3& end) {
  const float x = end.x / s.envelope_across, z = end.z / s.envelope_across;
  const float y = (end.y - s.envelope_y) / s.envelope_up;
  return 1.0F / std::max(1.0F, x * x + y * y + z * z);
}

void grow_trunk(const TreeShape& s, int depth, TreeSkeleton& out) {
  const std::uint64_t looks = core::mix64(s.root_key ^ kLooksSalt);
  const Fractions u(looks), w(core::mix64(looks));
  out.key[0] = s.root_key;
  out.parent[0] = 0;
  out.base[0] = glm::vec3(0.0F);
  out.direction[0] = normalised3({0.16F * (u.f[0] - 0.5F), 1.0F, 0.16F * (u.f[1] - 0.5F)});
  out.bend[0] = s.curvature * 0.5F * glm::vec3(w.f[0] - 0.5F, 0.0F, w.f[1] - 0.5F);
  out.length[0] = s.size_m * (0.9F + 0.2F * u.f[2]);
  out.radius_start[0] = s.radius_m * (0.85F + 0.3F * u.f[3]);
  out.radius_end[0] = tip_or(depth == 0, out.radius_start[0], 0.72F);
}

// Branch `number` of the `of` branches of node `parent`, written at index `i`.
void grow_branch(const TreeShape& s, TreeSkeleton& out, std::uint32_t parent, std::uint32_t number,
                 std::uint32_t of, bool tip, std::uint32_t i) {
  const std::uint64_t key = child_key(out.key[parent], number);
  const std::uint64_t looks = core::mix64(key ^ kLooksSalt);
  const Fractions u(looks), w(core::mix64(looks));
  const bool leader = number == 0;
  const float along =
      leader ? 0.0F : (static_cast<float>(number - 1) + 0.7F * u.f[0]) / static_cast<float>(of - 1);
  const float t = 1.0F - (parent == 0 ? 0.3F : 0.6F) * along;

  const float jitter = 1.0F + s.angle_variation * (2.0F * u.f[1] - 1.0F);
  const glm::vec3 tangent = normalised3(out.direction[parent] + 2.0F * t * out.bend[parent]);
  glm::vec3 direction = tangent;
  if (!leader) {
    const float tilt = s.angle_turns * jitter * (0.75F + 0.4F * along);
    const float start =
        static_cast<float>(static_cast<std::int32_t>((out.key[parent] >> 24) & 0xFFFFU)) *
        (1.0F / 65536.0F);
    const float azimuth = start + kGoldenTurns * static_cast<float>(number) +
                          0.3F * s.angle_variation * (u.f[2] - 0.5F);
    const Frame frame = frame_around(tangent);
    const glm::vec3 side = cos_turns(azimuth) * frame.u + sin_turns(azimuth) * frame.v;
    direction = cos_turns(tilt) * tangent + sin_turns(tilt) * side;
  }
  direction.y += leader ? 0.5F * s.tropism : s.tropism;

  const float start_radius = out.radius_start[parent];
  const float radius_there = start_radius + t * (out.radius_end[parent] - start_radius);
  out.key[i] = key;
  out.parent[i] = parent;
  out.base[i] = out.point(parent, t);
  out.direction[i] = normalised3(direction);
  out.bend[i] = s.curvature * 0.5F * glm::vec3(w.f[0] - 0.5F, w.f[1] - 0.5F, w.f[2] - 0.5F);
  out.bend[i].y += 0.35F * s.tropism;
  const float length = out.length[parent] * s.length_decay * (0.85F + 0.3F * u.f[3]) *
                       (leader ? 1.0F : 0.85F + 0.4F * (1.0F - t));
  const glm::vec3 end = out.base[i] + length * (out.direction[i] + out.bend[i]);
  out.length[i] = length * kept_share(s, end);
  out.radius_start[i] = radius_there * (leader ? 1.0F : s.radius_decay);
  out.radius_end[i] = tip_or(tip, out.radius_start[i], 0.72F);
}

}  // namespace

TreeShape::TreeShape(const Parameters& p)
    : root_key(core::mix64(static_cast<std::uint64_t>(p.integer(kTreeSeed)) ^ kRootSalt)),
      iterations(static_cast<int>(p.integer(kTreeIterations))),
      branches(static_cast<int>(p.integer(kTreeBranches))),
      size_m(static_cast<float>(p.real(kTreeSizeM))),
      radius_m(static_cast<float>(p.real(kTreeRadiusM))),
      angle_turns(static_cast<float>(p.real(kTreeBranchAngle) * 0.15915494309189535)),
      angle_variation(static_cast<float>(p.real(kTreeAngleVariation))),
      length_decay(static_cast<float>(p.real(kTreeLengthDecay))),
      radius_decay(static_cast<float>(p.real(kTreeRadiusDecay))),
      tropism(static_cast<float>(p.real(kTreeTropism))),
      curvature(static_cast<float>(p.real(kTreeCurvature))),
      flare(static_cast<float>(p.real(kTreeFlare))),
      leaf_scale(static_cast<float>(p.real(kTreeLeafScale))),
      leaf_hue(static_cast<float>(p.real(kTreeLeafHue))),
      colour_variation(static_cast<float>(p.real(kTreeColourVariation))),
      bark_tone(static_cast<float>(p.real(kTreeBarkTone))) {
  float length = size_m, sum = 0.0F;
  for (int i = 0; i < iterations; ++i) {
    length *= length_decay;
    sum += length;
  }
  envelope_across = 0.25F * size_m + 0.40F * sum;
  envelope_up = 0.25F * size_m + 0.40F * sum;
  envelope_y = 1.0F * size_m + 0.40F * sum;
}

TreeCount count_tree(const TreeShape& shape) {
  TreeCount result;
  std::array<std::uint64_t, kMaxTreeNodes> keys;  // of the depth before, then of this one
  std::array<std::uint64_t, kMaxTreeNodes> next_keys;
  keys[0] = shape.root_key;
  std::uint32_t nodes = 1, total = 1;
  result.nodes[0] = 1;
  for (int depth = 1; depth <= shape.iterations; ++depth) {
    std::uint32_t next = 0;
    for (std::uint32_t i = 0; i < nodes; ++i)
      next += child_count(keys[i], shape.branches);
    if (total + next > kMaxTreeNodes) break;
    if (depth < shape.iterations) {  // the keys of the last depth are never needed
      std::uint32_t written = 0;
      for (std::uint32_t i = 0; i < nodes; ++i) {
        const std::uint32_t children = child_count(keys[i], shape.branches);
        for (std::uint32_t c = 0; c < children; ++c)
          next_keys[written++] = child_key(keys[i], c);
      }
      std::copy_n(next_keys.begin(), next, keys.begin());
    }
    result.nodes[static_cast<std::size_t>(depth)] = next;
    result.depth = depth;
    nodes = next;
    total += next;
  }
  return result;
}

int tip_depth(const TreeShape& shape) {
  std::uint64_t most = 1, total = 1;
  for (int i = 0; i < shape.iterations && total <= kMaxTreeNodes; ++i) {
    most *= static_cast<std::uint64_t>(shape.branches) + 2;
    total += most;
  }
  return total <= kMaxTreeNodes ? shape.iterations : count_tree(shape).depth;
}

void grow_tree(const TreeShape& shape, int depth, std::uint32_t max_tips, TreeSkeleton& out) {
  grow_trunk(shape, depth, out);
  out.budget[0] = max_tips;
  out.depth = depth;
  out.first[0] = 0;
  out.first[1] = 1;
  out.count = 1;
  for (int d = 1; d <= depth; ++d) {
    const auto level = static_cast<std::size_t>(d);
    for (std::uint32_t parent = out.first[level - 1]; parent < out.first[level]; ++parent) {
      const std::uint32_t children = child_count(out.key[parent], shape.branches);
      const std::uint32_t share = out.budget[parent] / children;
      const std::uint32_t rest = out.budget[parent] % children;
      const auto turn = static_cast<std::uint32_t>(out.key[parent] & 0xFFFFU) % children;
      for (std::uint32_t c = 0; c < children; ++c) {
        const std::uint32_t rank = (c + turn) % children;  // the first `rest` in rank get one more
        const std::uint32_t budget =
            max_tips == kWholeTree ? kWholeTree : share + (rank < rest ? 1U : 0U);
        if (budget == 0) continue;
        out.budget[out.count] = budget;
        grow_branch(shape, out, parent, c, children, d == depth, out.count);
        ++out.count;
      }
    }
    out.first[level + 1] = out.count;
  }
}

}  // namespace psygen::models
