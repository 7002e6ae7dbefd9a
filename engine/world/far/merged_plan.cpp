#include "engine/world/far/merged_plan.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <new>

#include "engine/core/rounding.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/world/far/merged_models.hpp"
#include "engine/world/far/node_walk.hpp"
#include "engine/world/spacing.hpp"

namespace psygen::world {
namespace {

// A node of side s is drawn from a distance of about 2.4 s, at 700 pixels per radian. Models
// smaller than 1.2 pixels there are left out. Trees and bushes first share a form, up to
// kMaxTogether of them or twice the thinning.
constexpr double kNearestSides = 2.4, kPixelsPerRadian = 700, kMinPixels = 1.2;
constexpr std::uint32_t kMaxTogether = 8;
constexpr std::uint32_t kMaxThinning = 1U << 26;  // more than the instances of any node
constexpr std::uint64_t kMaxVertices = 65'536;
// Own meshes that do not fit get twice the error, up to this many times.
constexpr int kCoarserMeshes = 3;

// The number of models of this size, in pixels, that must share a form to be visible.
std::uint32_t min_together(double pixels) {
  const double ratio = kMinPixels / pixels;
  return static_cast<std::uint32_t>(std::ceil(std::min(ratio * ratio, 1e6)));
}

// The forms that a node has room for: one for each group, but where instances keep apart, as many
// as may stand. A node has more only where small patches of allowed ground lie far apart; the last
// ones are left out there.
std::uint64_t forms_at_most(const World& world, const Scatter& scatter, std::uint64_t groups) {
  const core::RoundToNearest rounding;
  const double side_m = world.block_size_m();
  const double share = kept_share(scatter.count / (side_m * side_m), scatter.spacing_m);
  const auto all = static_cast<double>(groups);
  const double deviation = std::sqrt(all * share * (1 - share));
  return std::min(groups, static_cast<std::uint64_t>(std::ceil(all * share + 4 * deviation)));
}

// `mesh_error_m`: the error that own meshes may have; 0: there are none.
void plan_scatters(const World& world, std::span<const FarScatter> scatters,
                   const ImpostorSet* pictures, double side, std::uint32_t thinning,
                   double mesh_error_m, LevelPlan& plan) {
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
      how.groups = (instances + how.together - 1) / how.together;
      how.forms = forms_at_most(world, far.scatter(), how.groups);
      how.each_is_synthesised = plan.form_level == 1 && !is_billboard(how.form) && far.is_cheap();
      if (mesh_error_m > 0 && how.together == 1 && how.form != Form::kPicture)
        how.mesh = far.own_mesh(pixels_per_m, mesh_error_m);
    }
    // Only worlds with thousands of scatters do not fit, even with the largest thinning.
    if (thinning >= kMaxThinning && plan.vertices + how.forms * how.vertices() > kMaxVertices)
      how.forms = 0;
    plan.vertices += how.forms * how.vertices();
    plan.triangles += how.forms * how.triangles();
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

Form form_of(const Outline& outline, int form_level, std::uint64_t together) {
  if (together > 1 || form_level >= 3) return Form::kTent;
  if (!outline.leafy) return Form::kChunk;
  const bool trunk = outline.trunk_radius > 0;
  if (form_level == 2) return trunk ? Form::kKiteTrunk : Form::kKite;
  return trunk ? Form::kSpindleTrunk : Form::kSpindle;
}

// The placed models of a node that are at least `min_m` large.
struct PlacedWalk {
  using Cell = models::QuadMap<models::BlockEdits>::Cell;

  const World& world;
  const TypesByName& types;
  core::BlockCoord corner;  // of the node
  float min_m;
  std::vector<PlacedForm>& forms;

  void add(const Cell& cell) const {
    if (cell.summary.placed == 0 || extent_m(cell.summary.reach_m) < min_m) return;
    if (cell.value && world.contains(cell.place.corner()))
      for (const models::PlacedModel& model : cell.value->placed)
        add(model, cell.place.corner());
    for (const auto& quarter : cell.quarters)
      if (quarter) add(*quarter);
  }

 private:
  void add(const models::PlacedModel& model, core::BlockCoord block) const {
    if (extent_m(model.reach_m) < min_m) return;
    const auto found = types.find(model.type);
    if (found == types.end() || !models::is_bound(model, *found->second)) return;
    const models::ModelType* type = found->second;
    const core::Bounds box = type->bounds(model.parameters);
    const glm::vec3 size = box.max - box.min;
    const float size_m = std::max({size.x, size.y, size.z});
    if (size_m < min_m) return;
    const auto blocks = [](std::int32_t from, std::int32_t to) {
      return static_cast<double>(static_cast<std::uint32_t>(to) - static_cast<std::uint32_t>(from));
    };
    const glm::dvec2 in_node{blocks(corner.x, block.x), blocks(corner.z, block.z)};
    forms.push_back(
        {&model, type, in_node * world.block_size_m() + glm::dvec2(model.local_m), size_m});
  }
};

void use_proxy(PlacedForm& form, ProxySize size) {
  form.mesh_level = PlacedForm::kProxy;
  form.vertices = size.vertices;
  form.triangles = size.triangles;
}

// Chooses the coarsest level of the model's mesh within this error.
void use_mesh(PlacedForm& form, double error_m) {
  const models::Parameters& p = form.model->parameters;
  form.mesh_level = form.type->level_count_of(p) - 1;
  while (form.mesh_level > 0 && form.type->level_error_m(p, form.mesh_level) > error_m)
    --form.mesh_level;
  const models::MeshSize size = form.type->mesh_size(p, form.mesh_level);
  form.vertices = size.vertex_count;
  form.triangles = size.triangle_count();
}

// Lets all but the largest models share proxies. Returns how many share one.
std::uint64_t share(std::vector<PlacedForm>& forms, std::size_t own, std::size_t shared) {
  std::ranges::stable_sort(forms, std::ranges::greater{}, &PlacedForm::size_m);
  const std::size_t left = forms.size() - own, together = (left + shared - 1) / shared;
  std::size_t kept = own;
  for (std::size_t i = own; i < forms.size(); i += together)
    forms[kept++] = forms[i];
  forms.resize(kept);
  return together;
}

}  // namespace

LevelPlan plan_level(const World& world, std::span<const FarScatter> scatters,
                     const ImpostorSet* pictures, int level, int form_level) {
  const double side = std::ldexp(world.block_size_m(), form_level);
  LevelPlan plan;
  plan.level = level;
  plan.form_level = form_level;
  std::uint32_t thinning = form_level <= 3 ? 1 : 3U << (2 * (form_level - 4));
  double error_m = form_error_m(world, form_level);
  plan_scatters(world, scatters, pictures, side, thinning, error_m, plan);
  for (int i = 0; i < kCoarserMeshes && plan.vertices > kMaxVertices; ++i)
    plan_scatters(world, scatters, pictures, side, thinning, error_m *= 2, plan);
  if (plan.vertices > kMaxVertices)
    plan_scatters(world, scatters, pictures, side, thinning, 0, plan);
  while (plan.vertices > kMaxVertices)
    plan_scatters(world, scatters, pictures, side, thinning *= 2, 0, plan);
  plan.box = box_of(world, scatters, std::ldexp(world.block_size_m(), level), plan);
  return plan;
}

std::size_t questions_per_tile(const World& world, const LevelPlan& plan) {
  constexpr std::uint64_t kTries = 4;  // of the positions that an instance may try, about
  if (world.has_costly_heights()) return 65'536;  // a place costs as much as a whole tile
  std::uint64_t groups = 0;
  for (const ScatterPlan& how : plan.scatters)
    groups += how.groups;
  return static_cast<std::size_t>(kTries * groups / ground_tiles(world, plan.level));
}

double work_of(const World& world, std::span<const FarScatter> scatters, const LevelPlan& plan) {
  constexpr double kQuestion = 1000;  // where a tile has too few of them for all its heights
  const auto vertices = static_cast<double>(world.terrain.integer(models::kTerrainSize));
  const double ground = 0.35 * vertices * vertices *
                        static_cast<double>(world.terrain.integer(models::kTerrainOctaves)) *
                        (world.terrain.real(models::kTerrainWarp) > 0 ? 8 : 1) *
                        (world.has_costly_heights() ? 10 : 1);
  const std::uint32_t tiles = plan.vertices > 0 ? ground_tiles(world, plan.level) : 0;
  const auto questions = static_cast<double>(questions_per_tile(world, plan));
  double sum = ground + std::min(ground, kQuestion * questions) * tiles;
  for (std::size_t s = 0; s < plan.scatters.size(); ++s) {
    const ScatterPlan& how = plan.scatters[s];
    const FarScatter& far = scatters[s];
    if (how.forms == 0) continue;
    const bool measured = how.form == Form::kPicture && plan.form_level == 1;
    if (how.mesh != nullptr) sum += 30.0 * how.mesh->vertices * static_cast<double>(how.forms);
    const double make = !how.each_is_synthesised && !measured ? 500 : far.is_leafy() ? 3000 : 400;
    const double search =
        (far.scatter().has_filter() ? 200 : 0) + (far.scatter().keeps_apart() ? 300 : 0);
    sum += make * static_cast<double>(how.forms) + search * static_cast<double>(how.groups) +
           std::ldexp(80, 2 * plan.level);
  }
  return sum + 100;
}

double form_error_m(const World& world, int form_level) {
  return kNearestSides / kPixelsPerRadian * std::ldexp(world.block_size_m(), form_level);
}

PlacedPlan::PlacedPlan(const World& world, const TypesByName& types,
                       std::span<const models::EditLayer* const> layers,
                       const models::QuadCoord& node, int form_level, std::uint64_t beside) {
  double error_m = form_error_m(world, form_level);
  const PlacedWalk walk{world, types, node.corner(), static_cast<float>(error_m), forms};
  for (const models::EditLayer* layer : layers) {
    if (layer == nullptr) continue;
    if (const PlacedWalk::Cell* cell = layer->blocks.at_or_below(node)) walk.add(*cell);
  }
  error_m *= 0.5;  // shapes are finer than what is left out
  shared_from = std::min(forms.size(), kMaxForms);
  if (forms.size() > kMaxForms) together = share(forms, shared_from = kMaxForms / 2, kMaxForms / 2);
  const std::uint64_t room = kMaxVertices - std::min(beside, kMaxVertices);
  const auto count = [this] {
    vertices = triangles = 0;
    for (const PlacedForm& form : forms) {
      vertices += form.vertices;
      triangles += form.triangles;
    }
    return vertices;
  };
  const ProxySize proxy = largest(form_level);
  for (int i = 0; i <= kCoarserMeshes; ++i, error_m *= 2) {
    for (std::size_t k = 0; k < forms.size(); ++k) {
      if (k >= shared_from || forms[k].type->surface() == core::SurfaceKind::kBark) {
        use_proxy(forms[k], proxy);
      } else {
        use_mesh(forms[k], error_m);
      }
    }
    if (count() <= room) return;
  }
  for (PlacedForm& form : forms)
    if (form.vertices > room / forms.size()) use_proxy(form, proxy);
  while (count() > room)
    forms.pop_back();
}

double PlacedPlan::work() const {
  double sum = 0;
  for (const PlacedForm& form : forms)
    sum += form.mesh_level == PlacedForm::kProxy ? 3000 : 30 * static_cast<double>(form.vertices);
  return sum;
}

std::optional<Form> make_placed_proxy(const PlacedForm& placed, int form_level,
                                      std::uint64_t together, SampleMesh& mesh, glm::vec2 turn,
                                      ProxyMesh& out) {
  try {  // user types may throw; our own code throws only when memory is exhausted
    mesh.make(*placed.type, placed.model->parameters);
    const auto outline = mesh.outline();
    if (!outline) return std::nullopt;
    const Form form = form_of(*outline, form_level, together);
    if (is_billboard(form)) {
      const Billboard board =
          billboard_of(form, *outline, mesh.silhouette(*placed.type), static_cast<float>(together));
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

float extent_m(const glm::vec3& reach_m) {
  return std::max(2 * reach_m.x, reach_m.y + reach_m.z);
}

double placed_error_m(const World& world, int node_level) {
  float largest_m = 0;
  for (const models::EditLayer* layer : {world.layer().get(), world.places.by_block.get()}) {
    const auto* cell = layer != nullptr ? layer->blocks.root() : nullptr;
    if (cell != nullptr && cell->summary.placed > 0)
      largest_m = std::max(largest_m, extent_m(cell->summary.reach_m));
  }
  const auto size_m = static_cast<double>(largest_m);
  return node_level > kMaxPlacedLevel ? size_m : std::min(size_m, form_error_m(world, node_level));
}

bool has_placed(const World& world, core::BlockCoord node, int node_level) {
  if (node_level < 1 || node_level > kMaxPlacedLevel) return false;
  const auto at = models::QuadCoord::of(node, static_cast<std::uint32_t>(node_level));
  const auto min_m = static_cast<float>(form_error_m(world, node_level));
  for (const models::EditLayer* layer : {world.layer().get(), world.places.by_block.get()}) {
    const auto* cell = layer != nullptr ? layer->blocks.at_or_below(at) : nullptr;
    if (cell != nullptr && cell->summary.placed > 0 && extent_m(cell->summary.reach_m) >= min_m)
      return true;
  }
  return false;
}

core::Bounds with_reach(const core::Bounds& box, const glm::vec3& reach_m) {
  if (reach_m == glm::vec3(0.0F)) return box;
  // Placed models stand in the node, whose square lies within the box.
  return {box.min - glm::vec3(reach_m.x, reach_m.z, reach_m.x),
          box.max + glm::vec3(reach_m.x, reach_m.y, reach_m.x)};
}

}  // namespace psygen::world
