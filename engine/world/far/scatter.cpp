#include "engine/world/far/scatter.hpp"

#include <algorithm>
#include <cmath>
#include <new>

#include "engine/models/kit/exact_math.hpp"
#include "engine/world/far/merged_models.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/world_parts.hpp"

namespace psygen::world {
namespace {

// Maximum number of vertices of a coarsest mesh that is made for every instance.
constexpr std::size_t kCheapVertices = 128;
// Bounds whose sizes differ by less than this factor are similar.
constexpr float kAlike = 1.04F;
// Up to this size on screen, a flat form looks the same as a solid one.
constexpr double kSmallPixels = 6;
// Other instances may exceed the representatives by this factor; parts beyond are cut.
constexpr float kRoom = 1.25F;

FarScatter::Reach reach_of(const core::Bounds& box) {
  return {std::max({-box.min.x, -box.min.z, box.max.x, box.max.z, 0.0F}), std::max(box.max.y, 0.0F),
          std::max(-box.min.y, 0.0F)};
}

FarScatter::Reach larger(const FarScatter::Reach& a, const FarScatter::Reach& b) {
  return {std::max(a.aside, b.aside), std::max(a.up, b.up), std::max(a.down, b.down)};
}

// Displacement of a billboard's corner along x; 0 for corners of solids. For the silhouette, the
// trunk faces one fixed direction.
float aside_of(Form form, const ProxyMesh& mesh, std::size_t corner) {
  return corner < size_of(form).solid_vertices ? 0 : mesh.aside[corner].x;
}

Silhouette silhouette_of_form(Form form, const Outline& outline) {
  ProxyMesh mesh;
  make_proxy(form, outline, 1, {0.8F, 0.6F}, mesh);
  std::array<glm::vec3, 9> places;
  const ProxySize size = size_of(form);
  for (std::size_t i = 0; i < size.vertices; ++i)
    places[i] = mesh.corners[i].position + glm::vec3(aside_of(form, mesh, i), 0, 0);
  return silhouette_of(std::span(places).first(size.vertices),
                       std::span(mesh.indices).first(std::size_t{3} * size.triangles));
}

// The albedo of an instance from above, weighted like that of its upper half.
glm::vec3 albedo_of(const Outline& outline) {
  const auto reflected = [](const Corner& c) { return c.colour * c.colour * c.ambient; };
  glm::vec3 sum = reflected(outline.top) * 0.5F;
  for (const Corner& c : outline.ring)
    sum += reflected(c) * 0.125F;
  return sum;
}

}  // namespace

float unlikeness(glm::vec2 a, glm::vec2 b) {
  const auto ratio = [](float u, float v) {
    return std::max(u, v) / std::max(std::min(u, v), 1e-6F);
  };
  return std::max(ratio(a.x, b.x), ratio(a.y, b.y));
}

models::Parameters sample_parameters(const World& world, const models::ModelType& type,
                                     const Scatter& scatter, std::uint32_t first,
                                     std::uint32_t number) {
  BlockObstacles block(world, {static_cast<std::int32_t>(number / scatter.count), 0});
  const Scattering scattering(world, type, scatter, block);
  return scattering.parameters(first + number % scatter.count);
}

FarScatters::FarScatters(std::shared_ptr<const World> world, const models::Registry& registry,
                         const FarScatters* before)
    : world_(std::move(world)), hashes_(parts_of(*world_, registry).models) {
  std::uint32_t first = 0;
  for (const Scatter& scatter : world_->scatter) {
    const models::ModelType& type = registry[scatter.model];
    const FarScatter* known = before != nullptr ? before->find(hashes_[all_.size()]) : nullptr;
    if (known != nullptr) {
      all_.emplace_back(*known, type, scatter);
    } else {
      all_.emplace_back(*world_, type, scatter, first);
    }
    first += scatter.count;
  }
}

const FarScatter* FarScatters::find(std::uint64_t hash) const {
  const auto at = std::ranges::find(hashes_, hash);
  return at == hashes_.end() ? nullptr : &all_[static_cast<std::size_t>(at - hashes_.begin())];
}

std::shared_ptr<const FarScatters> far_scatters(std::shared_ptr<const World> world,
                                                const models::Registry& registry,
                                                const FarScatters* before) {
  return std::make_shared<const FarScatters>(std::move(world), registry, before);
}

FarScatter::FarScatter(const World& world, const models::ModelType& type, const Scatter& scatter,
                       std::uint32_t first)
    : type_(&type), scatter_(&scatter), first_(first) {
  if (scatter.count == 0 || !type.is_seen_from_far()) return;
  try {  // user types may throw; our own code throws only when memory is exhausted
    measure(world);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (...) {
    representatives_.clear();
  }
  if (mean_.side_m2 <= 0) representatives_.clear();
  if (representatives_.empty()) return;
  measure_shape();
  fit_forms();
}

void FarScatter::measure(const World& world) {
  SampleMesh mesh;
  std::size_t vertices = 0;
  for (std::uint32_t k = 0; k < kRepresentatives; ++k) {
    const models::Parameters p = sample_parameters(world, *type_, *scatter_, first_, k);
    if (type_->mesh_size(p, type_->level_count() - 1).layout != core::VertexLayout::kModel) return;
    mesh.make(*type_, p);
    const auto outline = mesh.outline();
    if (!outline) continue;
    if (type_->turn_deg(p)) measure_own_meshes(p);
    vertices += mesh.vertices().size() / sizeof(core::ModelVertex);
    const core::Bounds box = type_->bounds(p);
    reach_ = larger(reach_, reach_of(box));
    const Silhouette silhouette = mesh.silhouette(*type_);
    representatives_.push_back(
        {*outline, silhouette, box.max.x - box.min.x, box.max.y - box.min.y});
    mean_.side_m2 += silhouette.side_m2;
    mean_.plan_m2 += silhouette.plan_m2;
  }
  if (representatives_.empty()) return;
  const auto count = static_cast<float>(representatives_.size());
  mean_ = {mean_.side_m2 / count, mean_.plan_m2 / count};
  cheap_ = vertices <= kCheapVertices * representatives_.size();
}

void FarScatter::measure_own_meshes(const models::Parameters& p) {
  own_meshes_.resize(static_cast<std::size_t>(type_->level_count_of(p)));
  for (int level = 0; OwnMesh & own : own_meshes_) {
    const models::MeshSize size = type_->mesh_size(p, level);
    own = {level, size.vertex_count, size.triangle_count(),
           std::max(own.error_m, type_->level_error_m(p, level))};
    ++level;
  }
}

void FarScatter::measure_shape() {
  float leafy = 0, ring = 0, gap = 0, slender = 0, extent = 0;
  for (const Representative& r : representatives_) {
    const Outline& o = r.outline;
    const float top = o.top.position.y, bottom = o.bottom.position.y;
    const float height = std::max(top - bottom, 1e-6F);
    leafy += o.leafy ? 1.0F : 0.0F;
    ring += (o.ring_height() - bottom) / height;
    gap += o.trunk_radius > 0 ? bottom / std::max(top, 1e-6F) : 0.0F;
    slender += top / std::max(o.ring_radius(), 1e-6F);
    extent += std::max(height, 2 * o.ring_radius());
  }
  const auto count = static_cast<float>(representatives_.size());
  leafy_ = 2 * leafy > count;
  conical_ = ring < 0.36F * count;
  trunk_ = leafy_ && gap > 0.08F * count;
  slender_ = slender > 2.5F * count;
  extent_m_ = extent / count;
}

void FarScatter::fit_forms() {
  for (std::size_t f = 0; f < kProxyCount; ++f) {
    const auto form = static_cast<Form>(f);
    if (is_billboard(form)) continue;
    float sum = 0;
    for (const Representative& r : representatives_)
      sum += silhouette_of_form(form, r.outline).side_m2;
    const float meshes = mean_.side_m2 * static_cast<float>(representatives_.size());
    widths_[f] = sum > 0 ? std::clamp(meshes / sum, 0.05F, 3.0F) : 1.0F;
  }
}

Form FarScatter::form_at(int node_level, double pixels_per_m) const {
  if (!leafy_) {
    if (extent_m_ * pixels_per_m < kSmallPixels || node_level >= 3) return Form::kTent;
    return node_level == 1 && slender_ ? Form::kSpindle : Form::kChunk;
  }
  if (node_level >= 3) return Form::kTent;
  if (node_level == 2) return conical_ ? Form::kTent : trunk_ ? Form::kKiteTrunk : Form::kKite;
  return trunk_ ? Form::kSpindleTrunk : Form::kSpindle;
}

const FarScatter::OwnMesh* FarScatter::own_mesh(double pixels_per_m, double max_error_m) const {
  if (own_meshes_.empty() || extent_m_ * pixels_per_m < kSmallPixels) return nullptr;
  const auto coarsest =
      std::ranges::find_if(own_meshes_.rbegin(), own_meshes_.rend() - 1,
                           [&](const OwnMesh& m) { return m.error_m <= max_error_m; });
  return &*coarsest;
}

Likeness FarScatter::like(float width_m, float height_m, std::uint64_t hash) const {
  const std::size_t count = representatives_.size(), start = hash % count;
  std::size_t best = start;
  float least = 1e30F;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = start + k < count ? start + k : start + k - count;
    const Representative& r = representatives_[i];
    const float apart = unlikeness({width_m, height_m}, {r.bounds_width_m, r.bounds_height_m});
    if (apart < least) {
      least = apart;
      best = i;
    }
    if (apart < kAlike) break;
  }
  const Representative& r = representatives_[best];
  return {&r, r.bounds_width_m > 0 ? width_m / r.bounds_width_m : 1,
          r.bounds_height_m > 0 ? height_m / r.bounds_height_m : 1};
}

FarScatter::Reach FarScatter::reach(float models) const {
  Reach most = reach_;
  for (const Representative& r : representatives_) {
    float aside = 0;
    for (const float width : widths_)
      aside = std::max(aside, width * r.outline.ring_radius());
    const glm::vec2 axis = r.outline.axis();
    const Billboard billboard = billboard_of(Form::kTent, r.outline, r.silhouette, models);
    aside = std::max(aside, billboard.half_width_m + 0.5F * billboard.lean_m);
    most.aside = std::max(most.aside, aside + std::abs(axis.x) + std::abs(axis.y));
  }
  return {kRoom * most.aside, kRoom * most.up, kRoom * most.down};
}

FarCover far_cover(const World& world, const FarScatters& scatters,
                   std::span<const double> placed) {
  const double block_m2 = world.block_size_m() * world.block_size_m();
  glm::vec3 light(0.0F);
  double covered = 0;
  for (std::size_t s = 0; s < world.scatter.size(); ++s) {
    const FarScatter& far = scatters.all()[s];
    for (const Representative& r : far.representatives()) {
      const double share = placed[s] * static_cast<double>(r.silhouette.plan_m2) /
                           (static_cast<double>(far.representatives().size()) * block_m2);
      light += albedo_of(r.outline) * static_cast<float>(share);
      covered += share;
    }
  }
  if (covered <= 0) return {};
  // Models at random positions overlap at random.
  return {light / static_cast<float>(covered),
          static_cast<float>(1 - models::exact_exp(-std::min(covered, 100.0)))};
}

}  // namespace psygen::world
