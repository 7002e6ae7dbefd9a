#include "engine/world/far/tree_impostors.hpp"

#include <algorithm>
#include <cmath>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "engine/core/assert.hpp"
#include "engine/models/task_type.hpp"
#include "engine/world/far/proxy_writer.hpp"
#include "engine/world/far/scatter.hpp"

namespace psygen::world {
namespace {

using models::MeshSize;
using models::MeshView;
using models::ModelType;
using models::Parameters;
using models::ParameterSpec;

// The first level with at most this many triangles is the coarsest mesh that looks like a tree. A
// type whose finest level has no more needs no impostors.
constexpr std::uint32_t kMaxTriangles = 320;
constexpr std::uint32_t kMaxBaked = 200'000;  // triangles; larger trees keep their hulls
// Number of instances, sorted by height, from which impostors are chosen.
constexpr std::uint32_t kCandidates = FarScatter::kRepresentatives;
// Fraction of an impostor's half width and height that stays free around the model.
constexpr float kMargin = 0.03F;
// Distance by which the top of a quad leans away from the viewer, relative to its half width, so
// that the crown is visible from above too.
constexpr float kLean = 0.5F;
constexpr float kTopSway = 0.5F;
constexpr std::uint64_t kImpostorEdition = 1;

std::vector<Corner> corners_of(const SampleMesh& mesh) {
  std::vector<Corner> corners;
  for (const core::ModelVertex& v : core::vertices_of<core::ModelVertex>(mesh.vertices()))
    corners.push_back(corner_of(v, mesh.box()));
  return corners;
}

// True if impostors are useful and possible for this type.
bool suits(const ModelType& type, const Parameters& p) {
  const MeshSize finest = type.mesh_size(p, 0);
  if (finest.layout != core::VertexLayout::kModel || finest.triangle_count() > kMaxBaked)
    return false;
  return type.turn_deg(p) ||
         (type.level_count_of(p) > 1 && finest.triangle_count() > kMaxTriangles);
}

// Without std::hypot, which may differ between C libraries.
float distance_from_axis(const glm::vec3& p) {
  return std::sqrt(p.x * p.x + p.z * p.z);
}

glm::vec2 size_of_bounds(const core::Bounds& box) {
  return {box.max.x - box.min.x, box.max.y - box.min.y};
}

// The extent of the coarsest mesh to any side, and up.
glm::vec2 coarse_size(const ModelType& type, const Parameters& p, SampleMesh& mesh) {
  mesh.make(type, p);
  const std::optional<Outline> outline = mesh.outline();
  if (!outline) return {0, 0};
  float radius_m = 0;
  for (const Corner& c : outline->ring)
    radius_m = std::max(radius_m, distance_from_axis(c.position));
  return {radius_m, outline->top.position.y};
}

// Uses the type's name, because registries may number the same type differently.
std::uint64_t key_of(const ModelType& type, const Parameters& p) {
  return core::combine(core::hash_bytes(std::as_bytes(std::span(type.name()))),
                       models::parameters_hash(type, p));
}

// Returns nothing for a mesh without leaves or without any extent.
std::optional<ImpostorModel> measured(models::ModelIndex index, const ModelType& type,
                                      const Parameters& p) {
  SampleMesh mesh;
  const glm::vec2 coarse_m = coarse_size(type, p, mesh);
  ImpostorModel m{index, p, size_of_bounds(type.bounds(p)), coarse_m, {0, 1e30F, -1e30F, 0}};
  mesh.make(type, p, 0);
  ImpostorFrame& frame = m.frame;
  float leaves = 0, solids = 0, ambient = 0;
  for (const Corner& c : corners_of(mesh)) {
    if (c.material == kLeaf) {
      frame.ambient += c.ambient;
      ++leaves;
    } else {
      ambient += c.ambient;
      ++solids;
    }
    frame.half_width_m = std::max(frame.half_width_m, distance_from_axis(c.position));
    frame.bottom_m = std::min(frame.bottom_m, c.position.y);
    frame.top_m = std::max(frame.top_m, c.position.y);
  }
  m.leafy = leaves > 0;
  if (!m.leafy) frame.ambient = ambient;
  frame.ambient /= std::max(m.leafy ? leaves : solids, 1.0F);
  m.turn_deg = type.turn_deg(p).value_or(0);
  m.key = key_of(type, p);
  frame.bottom_m = std::max(frame.bottom_m, 0.0F);  // parts in the ground are invisible
  frame.half_width_m *= 1 + kMargin;
  frame.top_m += kMargin * (frame.top_m - frame.bottom_m);
  const bool flat = !(frame.half_width_m > 1e-3F && frame.top_m - frame.bottom_m > 1e-3F);
  return (m.leafy || type.turn_deg(p)) && !flat ? std::optional(m) : std::nullopt;
}

// The measurements that another set has made.
std::optional<ImpostorModel> taken_over(const ImpostorSet* before, std::uint64_t key) {
  if (before == nullptr) return std::nullopt;
  const auto found = std::ranges::find(before->models(), key, &ImpostorModel::key);
  return found != before->models().end() ? std::optional(*found) : std::nullopt;
}

// The number of views between two rotations of a model.
std::uint32_t views_between(double from_deg, double to_deg) {
  const double views = (to_deg - from_deg) * core::kImpostorViews / 360;
  const auto whole = static_cast<std::int64_t>(std::floor(views + 0.5));
  constexpr std::int64_t kAll = core::kImpostorViews;
  return static_cast<std::uint32_t>((whole % kAll + kAll) % kAll);
}

// The factors that make `from` as large as `to`, within limits.
glm::vec2 stretch(glm::vec2 from, glm::vec2 to) {
  const auto factor = [](float u, float v) {
    return u > 1e-6F ? std::clamp(v / u, 0.5F, 2.0F) : 1.0F;
  };
  return {factor(from.x, to.x), factor(from.y, to.y)};
}

constexpr ParameterSpec kImpostorSchema[] = {
    models::placed(models::integer_parameter(
        "number", "", 0, models::HardRange{0, core::kMaxImpostors - 1},
        models::SoftRange{0, core::kMaxImpostors - 1}, "number of the impostor")),
};

class ImpostorType final : public models::TaskType {
 public:
  std::string_view name() const override { return "tree_picture"; }
  std::string_view doc() const override { return "a tree from several directions, as a texture"; }
  std::span<const ParameterSpec> parameters() const override { return kImpostorSchema; }
  double step_seconds() const override { return 10e-3; }

 private:
  void perform(const Parameters&) const override {}
};

class QuadType final : public ModelType {
 public:
  QuadType(std::shared_ptr<const ImpostorSet> pictures, const models::Registry& registry,
           models::ModelIndex model)
      : pictures_(std::move(pictures)),
        type_(&registry[model]),
        model_(model),
        name_("picture_of_" + std::string(type_->name())) {}

  std::string_view name() const override { return name_; }
  std::string_view doc() const override { return "a quad that shows a model's impostor"; }
  std::span<const ParameterSpec> parameters() const override { return type_->parameters(); }
  int level_count() const override { return 1; }
  double level_error_m(const Parameters&, int) const override { return 0; }
  core::Bounds bounds(const Parameters& p) const override { return type_->bounds(p); }
  MeshSize mesh_size(const Parameters&, int) const override {
    const ProxySize size = size_of(Form::kPicture);
    return {size.vertices, 3 * size.triangles, 0, core::VertexLayout::kModel};
  }
  // The time to make the coarsest mesh, which is measured.
  double complexity(const Parameters& p, int) const override {
    return type_->complexity(p, type_->level_count() - 1);
  }
  double steps(const Parameters& p, int) const override {
    return type_->steps(p, type_->level_count() - 1);
  }
  double step_seconds() const override { return type_->step_seconds(); }
  double log2_cost(const Parameters& p) const override { return type_->log2_cost(p); }
  std::uint64_t identity() const override {
    return core::combine(pictures_->identity_of_quads(model_), type_->identity());
  }
  bool may_run_on_main_thread() const override { return true; }
  core::Bounds synthesise(const Parameters& p, int, const MeshView& out) const override {
    ProxyMesh quad;
    SampleMesh scratch;
    pictures_->make_quad(model_, p, &scratch, quad);
    ProxyWriter writer(bounds(p), out);
    writer.add(Form::kPicture, quad, glm::vec3(0.0F), true);
    return writer.finish();
  }

 private:
  std::shared_ptr<const ImpostorSet> pictures_;
  const ModelType* type_;
  models::ModelIndex model_;
  std::string name_;
};

}  // namespace

ImpostorSet::ImpostorSet(const World& world, const models::Registry& registry,
                         const ImpostorSet* before)
    : identity_(kImpostorEdition) {
  for (std::size_t i = 0; i < registry.size(); ++i)
    types_.push_back(&registry[static_cast<models::ModelIndex>(i)]);
  std::size_t scatters = 0;
  std::uint32_t first = 0;
  std::vector<std::uint32_t> firsts;
  for (const Scatter& scatter : world.scatter) {
    const ModelType& type = registry[scatter.model];
    firsts.push_back(first);
    first += scatter.count;
    if (scatter.count > 0 && type.is_seen_from_far() && type.may_run_on_main_thread()) ++scatters;
  }
  if (scatters == 0) return;
  const std::size_t most =
      std::clamp<std::size_t>(core::kMaxImpostors / scatters, 1, kMaxOfScatter);
  for (std::size_t s = 0; s < world.scatter.size(); ++s) {
    try {  // user types may throw; our own code throws only when memory is exhausted
      add_scatter(world, world.scatter[s], firsts[s], most, before);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (...) {
    }
  }
}

void ImpostorSet::add_scatter(const World& world, const Scatter& scatter, std::uint32_t first,
                              std::size_t most, const ImpostorSet* before) {
  const ModelType& type = *types_[scatter.model];
  if (scatter.count == 0 || !type.is_seen_from_far() || !type.may_run_on_main_thread()) return;
  std::vector<std::pair<float, Parameters>> candidates;
  for (std::uint32_t k = 0; k < kCandidates; ++k) {
    const Parameters p = sample_parameters(world, type, scatter, first, k);
    if (!suits(type, p)) continue;
    const core::Bounds box = type.bounds(p);
    candidates.emplace_back(box.max.y - box.min.y, p);
  }
  if (candidates.empty()) return;
  if (type.turn_deg(candidates.front().second)) most = 1;
  std::ranges::stable_sort(candidates, {}, [](const auto& c) { return c.first; });
  for (std::size_t k = 0; k < most && models_.size() < core::kMaxImpostors; ++k) {
    const Parameters& p = candidates[(2 * k + 1) * candidates.size() / (2 * most)].second;
    const bool known = std::ranges::any_of(models_, [&](const ImpostorModel& m) {
      return m.model == scatter.model && (m.parameters == p || type.turn_deg(p));
    });
    if (known) continue;
    std::optional<ImpostorModel> model = taken_over(before, key_of(type, p));
    if (!model) model = measured(scatter.model, type, p);
    if (!model) continue;
    model->model = scatter.model;
    models_.push_back(*model);
    identity_ = core::combine(identity_, models::parameters_hash(type, p));
  }
}

std::uint64_t ImpostorSet::identity_of_impostor(std::size_t number) const {
  const ImpostorModel& m = models_[number];
  return core::combine(kImpostorEdition, models::parameters_hash(*types_[m.model], m.parameters));
}

// Quads refer to impostors by number, and start their search at any one of them.
std::uint64_t ImpostorSet::identity_of_quads(models::ModelIndex model) const {
  std::uint64_t identity = models_.size();
  for (std::size_t i = 0; i < models_.size(); ++i) {
    if (models_[i].model == model)
      identity = core::combine(core::combine(identity, i), identity_of_impostor(i));
  }
  return identity;
}

bool ImpostorSet::has(models::ModelIndex model) const {
  return std::ranges::any_of(models_, [&](const ImpostorModel& m) { return m.model == model; });
}

int ImpostorSet::first_level(models::ModelIndex model, const Parameters& p) const {
  const ModelType& type = *types_[model];
  int level = 0;
  while (level + 1 < type.level_count_of(p) &&
         type.mesh_size(p, level).triangle_count() > kMaxTriangles)
    ++level;
  // The last one that still looks like a tree is kept.
  return level + 1;
}

void ImpostorSet::make_quad(models::ModelIndex model, const Parameters& p, SampleMesh* scratch,
                            ProxyMesh& out) const {
  PSYGEN_CHECK(has(model), "the type must have impostors");
  const ModelType& type = *types_[model];
  if (type.turn_deg(p)) scratch = nullptr;  // one shape: bounds say all
  const glm::vec2 own_m =
      scratch != nullptr ? coarse_size(type, p, *scratch) : size_of_bounds(type.bounds(p));
  const auto size_of = [&](const ImpostorModel& m) {
    return scratch != nullptr ? m.coarse_m : m.bounds_m;
  };
  const std::uint64_t hash = core::mix64(p.hash());
  std::size_t best = models_.size();
  float least = 0;
  for (std::size_t k = 0; k < models_.size(); ++k) {
    const std::size_t i = (hash + k) % models_.size();
    const ImpostorModel& m = models_[i];
    if (m.model != model) continue;
    const float apart = unlikeness(own_m, size_of(m));
    if (best < models_.size() && !(apart < least)) continue;
    least = apart;
    best = i;
  }
  const ImpostorModel& m = models_[best];
  const glm::vec2 factor = stretch(size_of(m), own_m);
  const float half_m = factor.x * m.frame.half_width_m;
  const auto turn = type.turn_deg(p)
                        ? views_between(m.turn_deg, *type.turn_deg(p))
                        : static_cast<std::uint32_t>(hash >> 40) % core::kImpostorViews;
  Corner corner;
  corner.material = kLeaf | core::kImpostorBit;
  corner.ambient = m.frame.ambient;
  for (std::size_t i = 0; i < 4; ++i) {
    const bool right = i == 1 || i == 2, top = i >= 2;
    corner.position = {0, factor.y * (top ? m.frame.top_m : m.frame.bottom_m), 0};
    corner.sway = top && m.leafy ? kTopSway : 0;
    corner.colour = {static_cast<float>(best * core::kImpostorViews + turn) / 255,
                     right ? 1.0F : 0.0F, top ? 0.0F : 1.0F};
    out.corners[i] = corner;
    out.aside[i] = {right ? half_m : -half_m, top ? kLean * half_m : 0.0F};
  }
  static constexpr std::uint16_t kQuad[] = {0, 1, 2, 0, 2, 3};
  std::ranges::copy(kQuad, out.indices.begin());
}

core::ImpostorTexture ImpostorSet::bake(std::size_t number, int level, std::uint32_t views) const {
  const ImpostorModel& m = models_[number];
  const ModelType& type = *types_[m.model];
  SampleMesh mesh;
  mesh.make(type, m.parameters, level);
  return bake_impostor(corners_of(mesh), mesh.indices(type), m.frame, views);
}

core::ImpostorTexture ImpostorSet::stand_in(std::size_t number) const {
  const ImpostorModel& m = models_[number];
  return bake(number, types_[m.model]->level_count_of(m.parameters) - 1, 1);
}

std::unique_ptr<ModelType> make_impostor_type() {
  return std::make_unique<ImpostorType>();
}

Parameters picture_parameters(std::size_t number) {
  Parameters p;
  p.set_integer(0, static_cast<std::int64_t>(number));
  return p;
}

std::size_t picture_number(const Parameters& p) {
  return static_cast<std::size_t>(p.integer(0));
}

std::unique_ptr<ModelType> make_quad_type(std::shared_ptr<const ImpostorSet> pictures,
                                          const models::Registry& registry,
                                          models::ModelIndex model) {
  return std::make_unique<QuadType>(std::move(pictures), registry, model);
}

}  // namespace psygen::world
