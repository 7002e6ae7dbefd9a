#include "editor/view/picking.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "ecs/ecs.hpp"
#include "engine/models/registry.hpp"
#include "engine/scene/components.hpp"
#include "engine/scene/scene.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/world.hpp"

namespace psygen::editor {
namespace {

constexpr double kFarM = 20'000;
constexpr double kCrownFraction = 0.7;  // radius of the clickable sphere, of the bounding sphere

// Tight bounds of a drawn model, else its conservative bounds.
core::Bounds box_of(const Selection& model, const scene::Scene& scene) {
  std::optional<core::Bounds> tight;
  scene.entities()
      .each<const scene::MeshPlacement, const scene::MeshSource, const scene::MeshDemand,
            const scene::Mesh>(
          [&](std::span<const ecs::Entity>, std::span<const scene::MeshPlacement> placed,
              std::span<const scene::MeshSource> sources,
              std::span<const scene::MeshDemand> demands, std::span<const scene::Mesh> meshes) {
            for (std::size_t i = 0; i < placed.size(); ++i) {
              if (sources[i].index == model.index && placed[i].block == model.block &&
                  demands[i].drawn_level != scene::kNoLevel)
                tight = meshes[i].tight;
            }
          });
  return tight ? *tight : scene.registry()[model.model].bounds(model.parameters);
}

// A model whose clickable sphere is hit by a ray.
struct Crown {
  core::BlockCoord block;
  std::uint32_t index = 0;
  double distance_m = 0;
};

// The nearest drawn model that is hit, nearer than `longest_m`.
std::optional<Crown> crown_on(const query::Ray& ray, double longest_m, const scene::Scene& scene) {
  std::optional<Crown> found;
  const double block_m = scene.world().block_size_m();
  scene.entities()
      .each<const scene::MeshPlacement, const scene::MeshSource, const scene::MeshDemand>(
          [&](std::span<const ecs::Entity>, std::span<const scene::MeshPlacement> placed,
              std::span<const scene::MeshSource> sources,
              std::span<const scene::MeshDemand> demands) {
            for (std::size_t i = 0; i < placed.size(); ++i) {
              if (demands[i].drawn_level == scene::kNoLevel ||
                  sources[i].index >= scene::kMergedIndex)
                continue;
              const scene::MeshPlacement& at = placed[i];
              const glm::dvec3 middle = core::offset_m(at.block, ray.origin, block_m) +
                                        glm::dvec3(at.position) + glm::dvec3(at.middle);
              const double along = glm::dot(middle, ray.direction);
              const double aside = glm::length(middle - along * ray.direction);
              const double nearest = found ? found->distance_m : longest_m;
              if (along <= 0 || along >= nearest || aside > kCrownFraction * double{at.radius_m})
                continue;
              found = {at.block, sources[i].index, along};
            }
          });
  return found;
}

}  // namespace

glm::dvec3 direction_of(QPointF pixel, core::Extent size, const core::CameraPose& pose,
                        const core::Projection& projection) {
  const double half_height = std::tan(double{projection.vertical_fov} / 2);
  const double x = (2 * pixel.x() / size.width - 1) * half_height * double{projection.aspect};
  const double y = (1 - 2 * pixel.y() / size.height) * half_height;
  const glm::mat4 to_world = glm::transpose(core::view_rotation(pose));
  const glm::vec4 direction = to_world * glm::vec4(x, y, -1, 0);
  return glm::normalize(glm::dvec3(direction.x, direction.y, direction.z));
}

std::optional<Selection> pick(const scene::Scene& scene, const core::CameraPose& pose,
                              const glm::dvec3& direction) {
  const world::World& world = scene.world();
  query::World queries(world, scene.registry());
  query::Ray ray;
  ray.origin = pose.position;
  ray.direction = direction;
  ray.longest_m = kFarM;
  const auto hit = queries.cast(ray);
  if (!hit) return std::nullopt;
  Selection selection;
  selection.kind = hit->kind;
  selection.block = hit->block;
  selection.index = hit->index;
  selection.at = hit->position;
  selection.distance_m = hit->distance_m;
  if (hit->kind != query::HitKind::kModel) {
    if (const auto crown = crown_on(ray, hit->distance_m, scene)) {
      selection.kind = query::HitKind::kModel;
      selection.block = crown->block;
      selection.index = crown->index;
      selection.distance_m = crown->distance_m;
    }
  }
  if (selection.kind == query::HitKind::kNothing) return std::nullopt;
  return relocate_selection(selection, scene);
}

std::optional<glm::dvec2> GroundRays::at(const scene::Scene& scene, const core::CameraPose& pose,
                                         const glm::dvec3& direction) {
  BareGround& ground = *ground_.of(scene.world());
  query::Ray ray;
  ray.origin = pose.position;
  ray.direction = direction;
  ray.longest_m = kFarM;
  ray.models = ray.objects = false;
  const auto hit = ground.queries.cast(ray);
  if (!hit || hit->kind != query::HitKind::kGround) return std::nullopt;
  return ground.world.metres(hit->position);
}

std::optional<Selection> relocate_selection(const Selection& before, const scene::Scene& scene) {
  const world::World& world = scene.world();
  Selection selection = before;
  if (before.kind == query::HitKind::kGround) {
    selection.model = world.terrain_model;
    selection.parameters = world::terrain_parameters(world, before.block);
    return selection;
  }
  query::World queries(world, scene.registry());
  const auto placed = queries.placement(before.block, before.index);
  if (!placed) return std::nullopt;
  selection.model = placed->model;
  selection.parameters = placed->parameters;
  selection.at = {before.block, glm::dvec3(placed->position)};
  selection.box = box_of(selection, scene);
  return selection;
}

}  // namespace psygen::editor
