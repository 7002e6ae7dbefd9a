#include "engine/models/tree/tree.hpp"

#include <cmath>

#include "engine/models/tree/mesh.hpp"
#include "engine/models/tree/reach.hpp"
#include "engine/models/tree/spray_forms.hpp"

namespace psygen::models {
namespace {

// Kinds: the trunk, the leader that continues it, the limbs of the trunk, the side branches of
// other branches. Every node becomes a leader and a drawn number of others.
enum Kind : std::uint8_t { kTrunk, kLeader, kLimb, kSide };
constexpr Grammar kGrammar = [] {
  Grammar g;
  g.kinds = 4;
  for (std::size_t i = 0; i < g.first_rule.size(); ++i)
    g.first_rule[i] = static_cast<std::uint8_t>(i < 4 ? i : 4);
  for (std::size_t i = 0; i < 4; ++i) {
    g.rules[i].count[kLeader] = 1;
    g.rules[i].fixed = 1;
    g.rules[i].star = i == kTrunk ? kLimb : kSide;
  }
  return g;
}();

// The reach of reach.hpp in closed form, because every call of plan_of_tree() needs it.
core::Bounds bounds_of(const Parameters& p, const TreePlan& plan) {
  const double bend = 0.4331 * p.real(kTreeCurvature) + 0.35 * std::abs(p.real(kTreeTropism));
  const double size = p.real(kTreeSizeM), trunk = 1.1 * size;
  const double middle = plan.envelope_y, radius = plan.envelope_across;
  const double aside = size * trunk_side(plan);
  const double low = std::max(middle - 0.62 * size, trunk - middle);  // limbs grow from 0.7 up
  double in_crown = std::sqrt(low * low + 2 * aside * aside) / radius;
  double length = trunk, sum = 0;
  for (int i = 0; i < plan.iterations; ++i) {
    length *= p.real(kTreeLengthDecay) * 1.15 * 1.09;
    sum += length * (1 + bend);
    in_crown = reach_in_crown(in_crown, length / radius, bend);
  }
  const double foliage = 0.6 * size + 0.3 * radius * p.real(kTreeLeafScale);
  const double ring = ring_reach(bend) * p.real(kTreeRadiusM);
  const double foot = p.real(kTreeRadiusM) * (1.2 + 2.0 * p.real(kTreeFlare));
  const double crown = radius * in_crown;
  const auto side = static_cast<float>(
      std::max(std::max(std::min(aside + sum, crown), aside) + ring + foliage, 0.4 * aside + foot));
  const auto top =
      static_cast<float>(std::max(std::min(trunk + sum, middle + crown), trunk) + ring + foliage);
  const auto sunk = static_cast<float>(std::max(middle - crown, 0.62 * size - sum) - ring);
  const float bottom = -1.1F * sink_m(plan) - 0.12F * static_cast<float>(foot);
  return {{-side, std::min(bottom, sunk), -side}, {side, top, side}};
}

bool is_always_complete(int iterations, int branches) {
  std::uint64_t most = 1, total = 1;
  for (int i = 0; i < iterations && total <= kMaxTreeNodes; ++i) {
    most *= static_cast<std::uint64_t>(branches) + 2;
    total += most;
  }
  return total <= kMaxTreeNodes;
}

void set_kinds(const Parameters& p, TreePlan& plan) {
  const auto real = [&p](TreeParameter i) { return static_cast<float>(p.real(i)); };
  const float angle = real(kTreeBranchAngle) * 0.159154943F, decay = real(kTreeLengthDecay);
  const float tropism = real(kTreeTropism), bend_up = 0.35F * tropism;
  KindPlan side{.angle_high = 0.75F * angle,
                .angle_low = 1.15F * angle,
                .angle_variation = real(kTreeAngleVariation),
                .whorl = 0.381966011F,
                .along_low = 0.4F,
                .along_high = 1.0F,
                .length_high = 0.85F * decay,
                .length_foot = 1.25F * decay,
                .radius = real(kTreeRadiusDecay),
                .lift = tropism,
                .bend_up = bend_up,
                .curvature = real(kTreeCurvature),
                .leader = false,
                .leaves = LeavesOn::kTips};
  plan.kinds[kSide] = side;
  side.along_low = 0.7F;
  plan.kinds[kLimb] = side;
  side.along_low = 1.0F;
  side.leader = true;
  side.length_high = side.length_foot = decay;
  side.lift = 0.5F * tropism;
  side.radius = 1.0F;
  plan.kinds[kLeader] = plan.kinds[kTrunk] = side;
}

constexpr FoliagePlan kBroadleaf{.near = &kLeaflets,
                                 .far = &kPatch,
                                 .random = 0.7F,
                                 .out = 0.7F,
                                 .branch = 0.0F,
                                 .up = -0.25F,
                                 .side_random = 0.9F,
                                 .side_out = 0.7F,
                                 .side_up = 0.3F,
                                 .normal_up = 0.25F,
                                 .from = 0.0F,
                                 .cluster = 1.0F,
                                 .fill = 1.0F,
                                 .density = 1.6F};
constexpr std::array<std::array<float, 3>, 5> kLeafRamp = {{{0.21F, 0.33F, 0.17F},
                                                            {0.32F, 0.42F, 0.17F},
                                                            {0.62F, 0.56F, 0.17F},
                                                            {0.64F, 0.36F, 0.13F},
                                                            {0.50F, 0.18F, 0.12F}}};

class TreeType final : public PlannedTree {
 public:
  std::string_view name() const override { return "tree"; }
  std::string_view doc() const override {
    return "a broadleaf tree grown by a stochastic L-system; cost is proportional to "
           "branches^iterations";
  }
  std::span<const ParameterSpec> parameters() const override { return kTreeSchema; }
  double complexity(const Parameters& p, int level) const override {
    return kLevelShares[level] * std::pow(static_cast<double>(p.integer(kTreeBranches)),
                                          static_cast<double>(p.integer(kTreeIterations)));
  }
  double log2_cost(const Parameters& p) const override;
  TreePlan plan(const Parameters& p) const override { return plan_of_tree(p); }
};

double TreeType::log2_cost(const Parameters& p) const {
  const double n = std::max(0.0, static_cast<double>(p.integer(kTreeIterations)));
  const double m = std::max(1.0, static_cast<double>(p.integer(kTreeBranches)));
  const double grown = std::max(n * std::log2(m + 2.0) + 5.0, 12.0);
  const bool capped = n <= kTreeMaxIterations && m <= kTreeSchema[kTreeBranches].hard_max;
  return capped ? std::min(grown, 15.8) : grown;
}

}  // namespace

TreePlan plan_of_tree(const Parameters& p) {
  const auto real = [&p](TreeParameter i) { return static_cast<float>(p.real(i)); };
  const std::uint64_t root =
      core::mix64(static_cast<std::uint64_t>(p.integer(kTreeSeed)) ^ 0x5472656553656564ull);
  TreePlan plan;
  plan.grammar = &kGrammar;
  plan.axiom = kTrunk;
  plan.key = static_cast<std::uint32_t>(root);
  plan.salt = static_cast<std::uint32_t>(root >> 32);
  plan.iterations = static_cast<int>(p.integer(kTreeIterations));
  plan.branches = static_cast<int>(p.integer(kTreeBranches));
  plan.always_complete = is_always_complete(plan.iterations, plan.branches);
  plan.weights = nullptr;
  set_kinds(p, plan);
  plan.size_m = real(kTreeSizeM);
  plan.radius_m = real(kTreeRadiusM);
  plan.taper = 0.72F;
  plan.flare = real(kTreeFlare);
  plan.trunk_curvature = real(kTreeCurvature);
  float length = plan.size_m, sum = 0.0F;
  for (int i = 0; i < plan.iterations; ++i) {
    length *= real(kTreeLengthDecay);
    sum += length;
  }
  plan.envelope_across = plan.envelope_up = 0.25F * plan.size_m + 0.40F * sum;
  plan.envelope_y = plan.size_m + 0.40F * sum;
  plan.limit_across = plan.limit_up = 1.0F / plan.envelope_across;
  plan.foliage = kBroadleaf;
  plan.foliage.fill = real(kTreeLeafScale);
  plan.ramp = kLeafRamp;
  plan.cyclic = false;
  plan.hue = real(kTreeLeafHue);
  plan.colour_variation = real(kTreeColourVariation);
  const float tone = real(kTreeBarkTone);
  plan.bark = {0.98F * (0.48F - 0.12F * tone), 0.98F * (0.46F - 0.18F * tone),
               0.98F * (0.43F - 0.22F * tone)};
  plan.bark_contrast = 0.143F;
  plan.bounds = bounds_of(p, plan);
  return plan;
}

std::unique_ptr<ModelType> make_tree_type() {
  return std::make_unique<TreeType>();
}

}  // namespace psygen::models
