#include "engine/world/far/merged_plan.hpp"

#include <algorithm>
#include <cmath>
#include <new>

#include "engine/models/terrain/terrain.hpp"
#include "engine/world/far/node_walk.hpp"

namespace psygen::world {
namespace {

// A node of side s is drawn from a distance of about 2.4 s, at 700 pixels per radian. Models
// smaller than 1.2 pixels there are left out. Trees and bushes first share a form, up to
// kMaxTogether of them or twice the thinning.
constexpr double kNearestSides = 2.4, kPixelsPerRadian = 700, kMinPixels = 1.2;
constexpr std::uint32_t kMaxTogether = 8;
constexpr std::uint32_t kMaxThinning = 1U << 26;  // more than the instances of any node
constexpr std::uint64_t kMaxVertices = 65'536;

// The number of models of this size, in pixels, that must share a form to be visible.
std::uint32_t min_together(double pixels) {
  const double ratio = kMinPixels / pixels;
  return static_cast<std::uint32_t>(std::ceil(std::min(ratio * ratio, 1e6)));
}

void plan_scatters(std::span<const FarScatter> scatters, const ImpostorSet* pictures, double side,
                   std::uint32_t thinning, LevelPlan& plan) {
  plan.scatters.clear();
  plan.vertices = plan.triangles = 0;
  const double pixels_per_m = kPixelsPerRadian / (kNearestSides * side);
  for (const FarScatter& far : scatters) {
    ScatterPlan how;
    const double size_m = std::sqrt(far.mean_silhouette().side_m2);
    const std::uint32_t least = far.empty() ? 0 : min_together(size_m * pixels_per_m);
    how.together = std::max(thinning, far.is_leafy() ? least : 1);
    const std::uint32_t most = far.is_leafy() ? std::max(2 * thinning, kMaxTogether) : thinning;
    if (!far.empty() && least <= most) {
      const bool pictured = pictures != nullptr && plan.form_level <= kMaxImpostorLevel &&
                            pictures->has(far.scatter().model);
      how.form = how.together > 1 ? Form::kTent
                 : pictured       ? Form::kPicture
                                  : far.form_at(plan.form_level, pixels_per_m);
      const std::uint64_t instances = std::uint64_t{far.scatter().count} << (2 * plan.level);
      how.forms = (instances + how.together - 1) / how.together;
      how.each_is_synthesised = plan.form_level == 1 && !is_billboard(how.form) && far.is_cheap();
    }
    // Only worlds with thousands of scatters do not fit, even with the largest thinning.
    if (thinning >= kMaxThinning &&
        plan.vertices + how.forms * size_of(how.form).vertices > kMaxVertices)
      how.forms = 0;
    plan.vertices += how.forms * size_of(how.form).vertices;
    plan.triangles += how.forms * size_of(how.form).triangles;
    plan.scatters.push_back(how);
  }
}

core::Bounds box_of(const World& world, std::span<const FarScatter> scatters, double side_m,
                    const LevelPlan& plan) {
  FarScatter::Reach most;
  for (std::size_t s = 0; s < scatters.size(); ++s) {
    if (plan.scatters[s].forms == 0) continue;
    const std::uint64_t instances = std::uint64_t{scatters[s].scatter().count} << (2 * plan.level);
    const FarScatter::Reach reach = scatters[s].reach(
        static_cast<float>(std::min<std::uint64_t>(plan.scatters[s].together, instances)));
    most = {std::max(most.aside, reach.aside), std::max(most.up, reach.up),
            std::max(most.down, reach.down)};
  }
  const auto side = static_cast<float>(side_m);
  const auto relief = static_cast<float>(world.terrain.real(models::kTerrainReliefM));
  return {{-most.aside, -most.down, -most.aside},
          {side + most.aside, relief + most.up, side + most.aside}};
}

// The largest form of a placed model in a mesh with the forms of this node level.
ProxySize largest(int form_level) {
  ProxySize most{0, 0, 0};
  const auto add = [&most](Form form) {
    const ProxySize size = size_of(form);
    most.vertices = std::max(most.vertices, size.vertices);
    most.triangles = std::max(most.triangles, size.triangles);
  };
  add(Form::kTent);
  if (form_level <= 2) {
    add(Form::kKiteTrunk);
    add(Form::kChunk);
  }
  if (form_level <= 1) add(Form::kSpindleTrunk);
  return most;
}

Form form_of(const Outline& outline, const PlacedPlan& plan) {
  if (plan.together > 1 || plan.form_level >= 3) return Form::kTent;
  if (!outline.leafy) return Form::kChunk;
  const bool trunk = outline.trunk_radius > 0;
  if (plan.form_level == 2) return trunk ? Form::kKiteTrunk : Form::kKite;
  return trunk ? Form::kSpindleTrunk : Form::kSpindle;
}

}  // namespace

LevelPlan plan_level(const World& world, std::span<const FarScatter> scatters,
                     const ImpostorSet* pictures, int level, int form_level) {
  const double side = std::ldexp(world.block_size_m(), form_level);
  LevelPlan plan;
  plan.level = level;
  plan.form_level = form_level;
  std::uint32_t thinning = form_level <= 3 ? 1 : 3U << (2 * (form_level - 4));
  plan_scatters(scatters, pictures, side, thinning, plan);
  while (plan.vertices > kMaxVertices)
    plan_scatters(scatters, pictures, side, thinning *= 2, plan);
  plan.box = box_of(world, scatters, std::ldexp(world.block_size_m(), level), plan);
  return plan;
}

double work_of(const World& world, std::span<const FarScatter> scatters, const LevelPlan& plan) {
  const auto vertices = static_cast<double>(world.terrain.integer(models::kTerrainSize));
  const double ground = 0.35 * vertices * vertices *
                        static_cast<double>(world.terrain.integer(models::kTerrainOctaves)) *
                        (world.terrain.real(models::kTerrainWarp) > 0 ? 8 : 1);
  double sum = ground * static_cast<double>(ground_tiles(plan.level) + 1);  // 1: the whole node
  for (std::size_t s = 0; s < scatters.size(); ++s) {
    const ScatterPlan& how = plan.scatters[s];
    const FarScatter& far = scatters[s];
    if (how.forms == 0) continue;
    const bool measured = how.form == Form::kPicture && plan.form_level == 1;
    const double make = !how.each_is_synthesised && !measured ? 500 : far.is_leafy() ? 3000 : 400;
    const double search = far.scatter().has_filter() ? 200 : 0;
    sum += (make + search) * static_cast<double>(how.forms) + std::ldexp(80, 2 * plan.level);
  }
  return sum + 100;
}

PlacedPlan::PlacedPlan(int level, std::uint64_t models, std::uint64_t vertices)
    : form_level(level) {
  const std::uint64_t room =
      (kMaxVertices - std::min(vertices, kMaxVertices)) / largest(level).vertices;
  const std::uint64_t most = std::min(kMaxProxies, room);
  if (models == 0 || most == 0) return;
  together = (models + most - 1) / most;
  forms = (models + together - 1) / together;
}

std::uint64_t PlacedPlan::vertices() const {
  return forms * largest(form_level).vertices;
}

std::uint64_t PlacedPlan::triangles() const {
  return forms * largest(form_level).triangles;
}

std::optional<Form> make_placed_proxy(const models::ModelType& type,
                                      const models::Parameters& parameters, const PlacedPlan& plan,
                                      SampleMesh& mesh, glm::vec2 turn, ProxyMesh& out) {
  if (plan.forms == 0) return std::nullopt;
  try {  // user types may throw; our own code throws only when memory is exhausted
    mesh.make(type, parameters);
    const auto outline = mesh.outline();
    if (!outline) return std::nullopt;
    const Form form = form_of(*outline, plan);
    if (is_billboard(form)) {
      const Billboard board =
          billboard_of(form, *outline, mesh.silhouette(type), static_cast<float>(plan.together));
      make_billboard(form, *outline, board, out);
    } else {
      make_proxy(form, *outline, 1, turn, out);
    }
    return form;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (...) {
    return std::nullopt;
  }
}

core::Bounds with_reach(const core::Bounds& box, const glm::vec3& reach_m) {
  if (reach_m == glm::vec3(0.0F)) return box;
  // Placed models stand in the node, whose square lies within the box.
  return {box.min - glm::vec3(reach_m.x, reach_m.z, reach_m.x),
          box.max + glm::vec3(reach_m.x, reach_m.y, reach_m.x)};
}

}  // namespace psygen::world
