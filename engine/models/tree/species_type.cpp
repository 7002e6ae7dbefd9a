// A species as a model type: schema, bounds, costs, and the plan of one tree.
#include <cmath>

#include "engine/core/assert.hpp"
#include "engine/models/tree/mesh.hpp"
#include "engine/models/tree/reach.hpp"
#include "engine/models/tree/species_grammar.hpp"
#include "engine/models/tree/spray_forms.hpp"

namespace psygen::models {
namespace {

constexpr std::size_t kMaxBranches = 8;
constexpr float kTurnsPerDegree = 1.0F / 360.0F;

float f(double v) {
  return static_cast<float>(v);
}

KindPlan kind_plan(const SpeciesKind& k) {
  const LeavesOn leaves = k.leaves == "all"    ? LeavesOn::kAll
                          : k.leaves == "tips" ? LeavesOn::kTips
                                               : LeavesOn::kNone;
  return {.angle_high = f(k.angle_deg) * kTurnsPerDegree,
          .angle_low = f(k.angle_low_deg) * kTurnsPerDegree,
          .angle_variation = f(k.angle_variation),
          .whorl = f(k.whorl_deg) * kTurnsPerDegree,
          .along_low = k.leader ? 1.0F : f(k.along_low),
          .along_high = k.leader ? 1.0F : f(k.along_high),
          .length_high = f(k.length),
          .length_foot = f(k.length_low),
          .radius = f(k.radius),
          .lift = f(k.leader ? 0.5 * k.tropism : k.tropism),
          .bend_up = f(0.35 * k.tropism),
          .curvature = f(k.curvature),
          .leader = k.leader,
          .leaves = leaves};
}

FoliagePlan foliage_plan(const SpeciesFoliage& s) {
  const SprayForm* near = s.form == "leaflets"  ? &kLeaflets
                          : s.form == "needles" ? &kNeedles
                          : s.form == "fronds"  ? &kFrond
                          : s.form == "clump"   ? &kClump
                                                : nullptr;
  return {.near = near,
          .far = near == nullptr ? nullptr : &kPatch,
          .random = f(s.random),
          .out = f(s.out),
          .branch = f(s.branch),
          .up = f(s.up),
          .side_random = f(s.side_random),
          .side_out = f(s.side_out),
          .side_up = f(s.side_up),
          .normal_up = f(s.normal_up),
          .from = f(s.from),
          .cluster = f(s.cluster),
          .fill = f(s.size),
          .density = f(s.density)};
}

std::uint64_t identity_of(const Species& s) {
  std::uint64_t h = core::hash_bytes(std::as_bytes(std::span(s.name)));
  const auto add = [&h](double v) { h = core::combine(h, std::bit_cast<std::uint64_t>(v)); };
  const auto add_number = [&](std::string_view, double v, const NumberSpec&) { add(v); };
  const auto add_text = [&h](const std::string& text) {
    h = core::combine(h, core::hash_bytes(std::as_bytes(std::span(text))));
  };
  for (const std::int64_t v : {s.iterations, s.branches, s.spread})
    add(static_cast<double>(v));
  add_text(s.axiom);
  visit_numbers(s, add_number);
  for (const SpeciesKind& k : s.kinds) {
    add_text(k.symbol);
    add_text(k.leaves);
    add(k.leader ? 1 : 0);
    visit_kind_numbers(k, add_number);
  }
  for (const SpeciesRule& rule : s.rules) {
    add_text(rule.from);
    add_text(rule.to);
    add(rule.probability);
  }
  add_text(s.foliage.form);
  visit_foliage_numbers(s.foliage, add_number);
  for (const auto& colour : s.colours.season)
    for (const double c : colour)
      add(c);
  for (const double c : s.colours.bark)
    add(c);
  add(s.colours.bark_contrast);
  return h;
}

class SpeciesType final : public PlannedTree {
 public:
  explicit SpeciesType(Species species)
      : species_(std::move(species)),
        grammar_(grammar_of(species_)),
        axiom_(kind_of(species_, species_.axiom)) {
    set_schema();
    for (std::size_t m = 0; m <= kMaxBranches; ++m) {
      weights_[m] = path_weights(grammar_, static_cast<int>(m));
      for (std::size_t n = 0; n <= kMaxTreeIterations; ++n) {
        mean_log2_[m][n] = branches_log2(static_cast<double>(n), static_cast<double>(m), false);
        max_log2_[m][n] = branches_log2(static_cast<double>(n), static_cast<double>(m), true);
      }
    }
    identity_ = identity_of(species_);
    set_plan();
    for (int n = 0; n <= kMaxTreeIterations; ++n) {
      TreePlan tree = plan_;
      tree.iterations = n;
      tree.size_m = 1.0F;
      set_envelope(tree);
      reach_[static_cast<std::size_t>(n)] = reach_of(tree);
    }
  }

  std::string_view name() const override { return species_.name; }
  std::string_view doc() const override { return species_.doc; }
  std::span<const ParameterSpec> parameters() const override { return schema_; }
  std::uint64_t identity() const override { return identity_; }
  double complexity(const Parameters& p, int level) const override {
    const auto n = static_cast<std::size_t>(
        std::clamp<std::int64_t>(p.integer(kSpeciesIterations), 0, kMaxTreeIterations));
    const auto m = static_cast<std::size_t>(
        std::clamp<std::int64_t>(p.integer(kSpeciesBranches), 0, kMaxBranches));
    return kLevelShares[level] * std::min(std::exp2(mean_log2_[m][n]), double{kMaxTreeNodes});
  }
  double log2_cost(const Parameters& p) const override {
    const auto n = static_cast<double>(p.integer(kSpeciesIterations));
    const auto m = static_cast<double>(p.integer(kSpeciesBranches));
    // At most 30 triangles of bark per branch and eight per spray; the total has a lower limit.
    const double each = 30 + 8 * std::max(species_.foliage.density, 0.0);
    const double grown =
        std::max(branches_log2(n, std::max(m, 0.0), true) + std::log2(each), 12.0) + 0.9;
    return n <= kMaxTreeIterations && m <= kMaxBranches ? std::min(grown, 16.3) : grown;
  }
  TreePlan plan(const Parameters& p) const override;

 private:
  double branches_log2(double iterations, double branches, bool most) const {
    return log2_branches(grammar_, axiom_, iterations, branches, most);
  }
  void set_schema();
  void set_plan();
  void set_envelope(TreePlan& tree) const;
  core::Bounds bounds_of(const TreePlan& plan) const;
  void shed_leaves(float season, FoliagePlan& foliage) const;

  Species species_;
  Grammar grammar_;
  std::uint8_t axiom_;
  std::array<ParameterSpec, kSpeciesParameterCount> schema_;
  std::array<PathWeights, kMaxBranches + 1> weights_;
  std::array<std::array<double, kMaxTreeIterations + 1>, kMaxBranches + 1> mean_log2_, max_log2_;
  std::array<TreeReach, kMaxTreeIterations + 1> reach_;  // indexed by iterations
  std::uint64_t identity_ = 0;
  float decay_ = 0.3F;  // length over the parent's, of the longest kind
  double ring_ = 0;     // farthest vertex of a branch's rings, over the trunk's radius
  TreePlan plan_{};     // the part that all trees of the species share
};

void SpeciesType::set_schema() {
  const auto n = static_cast<double>(species_.iterations);
  const auto m = static_cast<double>(species_.branches);
  schema_[kSpeciesSeed] = placed(integer_parameter("seed", "", 1, {-9.3e18, 9.3e18}, {0, 1e6},
                                                   "selects one tree of the species"));
  schema_[kSpeciesIterations] =
      integer_parameter("iterations", "1", n, {1, kMaxTreeIterations}, {std::max(n - 1, 1.0), n},
                        "number of times that the rules apply");
  schema_[kSpeciesBranches] =
      integer_parameter("branches", "1", m, {1, kMaxBranches}, {std::max(m - 1, 1.0), m},
                        "mean number of branches that a star fills up to");
  schema_[kSpeciesSizeM] =
      real_parameter("size_m", "m", species_.size_m, {0.05, 30},
                     {0.7 * species_.size_m, std::min(1.4 * species_.size_m, 30.0)},
                     "length of the trunk up to its end");
  schema_[kSpeciesRadiusM] =
      real_parameter("radius_m", "m", species_.radius_m, {0.002, 3},
                     {0.7 * species_.radius_m, std::min(1.4 * species_.radius_m, 3.0)},
                     "radius of the trunk above its flare");
  schema_[kSpeciesSeason] = real_parameter("season", "1", 1, {0, 4}, {0, 4},
                                           "0 spring, 1 summer, 2 autumn, 3 winter, 4 spring");
  schema_[kSpeciesLeafScale] = real_parameter("leaf_scale", "1", 1, {0.1, 3}, {0.7, 1.4},
                                              "size of leaves, relative to the species");
  schema_[kSpeciesColourVariation] =
      real_parameter("colour_variation", "1", species_.colour_variation, {0, 1}, {0, 1},
                     "spread of colour between leaves and trees");
  for (ParameterSpec& spec : schema_)  // ranges around extreme defaults
    spec.soft_min = std::max(spec.soft_min, spec.hard_min);
}

void SpeciesType::set_plan() {
  plan_.grammar = &grammar_;
  plan_.axiom = axiom_;
  for (std::size_t i = 0; i < species_.kinds.size(); ++i)
    plan_.kinds[i] = kind_plan(species_.kinds[i]);
  for (std::size_t i = 0; i < species_.kinds.size(); ++i)
    if (i != axiom_) decay_ = std::max(decay_, plan_.kinds[i].length_high);
  double bend = 0.3536 * species_.trunk_curvature;
  for (std::size_t i = 0; i < species_.kinds.size(); ++i)
    bend = std::max(
        bend, 0.4331 * double{plan_.kinds[i].curvature} + std::abs(double{plan_.kinds[i].bend_up}));
  ring_ = ring_reach(bend);
  plan_.taper = f(species_.taper);
  plan_.flare = f(species_.flare);
  plan_.trunk_curvature = f(species_.trunk_curvature);
  plan_.foliage = foliage_plan(species_.foliage);
  plan_.cyclic = true;
  for (std::size_t i = 0; i < 5; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      plan_.ramp[i][c] = f(species_.colours.season[i % 4][c]);
  for (std::size_t c = 0; c < 3; ++c)
    plan_.bark[c] = f(species_.colours.bark[c]);
  plan_.bark_contrast = f(species_.colours.bark_contrast);
}

// Sets the envelope of a tree from its size and iterations.
void SpeciesType::set_envelope(TreePlan& tree) const {
  float length = tree.size_m, sum = 0.0F;
  for (int i = 0; i < tree.iterations; ++i) {
    length *= decay_;
    sum += length;
  }
  const float limit = f(species_.crown_limit);
  const float extent = 0.25F * tree.size_m + 0.40F * sum;
  tree.envelope_across = tree.envelope_up = limit > 0.0F ? limit * extent : extent;
  tree.envelope_y = tree.size_m + 0.40F * sum;
  tree.limit_across = tree.limit_up = limit > 0.0F ? 1.0F / tree.envelope_across : 0.0F;
}

core::Bounds SpeciesType::bounds_of(const TreePlan& tree) const {
  const double size = tree.size_m;
  const TreeReach& reach = reach_[static_cast<std::size_t>(tree.iterations)];
  const double foliage =
      tree.foliage.near == nullptr
          ? 0.02 * size
          : 0.6 * size + 0.3 * double{tree.envelope_across} * double{tree.foliage.fill};
  const double ring = ring_ * double{tree.radius_m};
  const double foot = double{tree.radius_m} * (1.2 + 2.0 * double{tree.flare});
  const auto side = static_cast<float>(
      std::max(size * reach.side + ring + foliage, 0.4 * size * trunk_side(tree) + foot));
  const auto top = static_cast<float>(size * reach.top + ring + foliage);
  const float bottom = -1.1F * sink_m(tree) - 0.12F * static_cast<float>(foot) - 0.1F * side;
  return {{-side, std::min(bottom, static_cast<float>(size * reach.low - ring)), -side},
          {side, top, side}};
}

// Removes leaves by season; remaining leaves keep their size. Below 5 % all leaves are removed.
void SpeciesType::shed_leaves(float season, FoliagePlan& foliage) const {
  const SpeciesFoliage& s = species_.foliage;
  const float shares[5] = {f(s.density_spring), f(s.density_summer), f(s.density_autumn),
                           f(s.density_winter), f(s.density_spring)};
  const auto i = static_cast<std::size_t>(std::min(season, 3.0F));
  const float share = shares[i] + (season - static_cast<float>(i)) * (shares[i + 1] - shares[i]);
  if (share < 0.05F) {
    foliage.near = foliage.far = nullptr;
    return;
  }
  foliage.density *= share;
  foliage.fill *= std::sqrt(share);
  foliage.hull *= std::sqrt(share);
}

TreePlan SpeciesType::plan(const Parameters& p) const {
  const auto branches = static_cast<std::size_t>(p.integer(kSpeciesBranches));
  const std::uint64_t root =
      core::mix64(static_cast<std::uint64_t>(p.integer(kSpeciesSeed)) ^ 0x5370656369657331ull);
  TreePlan tree = plan_;
  tree.key = static_cast<std::uint32_t>(root);
  tree.salt = static_cast<std::uint32_t>(root >> 32);
  tree.iterations = static_cast<int>(p.integer(kSpeciesIterations));
  tree.branches = static_cast<int>(branches);
  const auto n = static_cast<std::size_t>(tree.iterations);
  tree.always_complete = max_log2_[branches][n] < 11.5;  // 2^11.5 < kMaxTreeNodes
  tree.weights = &weights_[branches];
  tree.size_m = f(p.real(kSpeciesSizeM));
  tree.radius_m = f(p.real(kSpeciesRadiusM));
  set_envelope(tree);
  tree.foliage.fill *= f(p.real(kSpeciesLeafScale));
  tree.hue = 0.25F * f(p.real(kSpeciesSeason));
  shed_leaves(f(p.real(kSpeciesSeason)), tree.foliage);
  tree.colour_variation = f(p.real(kSpeciesColourVariation));
  tree.bounds = bounds_of(tree);
  return tree;
}

}  // namespace

core::Result<std::unique_ptr<ModelType>> make_species_type(const Species& species) {
  if (auto valid = validate(species); !valid)
    return tl::unexpected<core::Error>(std::move(valid.error()));
  return std::make_unique<SpeciesType>(species);
}

bool is_species_type(const ModelType& type) {
  return dynamic_cast<const SpeciesType*>(&type) != nullptr;
}

TreePlan plan_of_species(const ModelType& type, const Parameters& p) {
  const auto* species = dynamic_cast<const SpeciesType*>(&type);
  PSYGEN_CHECK(species != nullptr, "the type was made by make_species_type");
  return species->plan(p);
}

}  // namespace psygen::models
