#include "editor/view/picking.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/world/placement.hpp"

namespace psygen::editor {
namespace {

constexpr double kFarM = 20'000;

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

std::optional<Selection> pick(const world::World& world, const models::Registry& registry,
                              const core::CameraPose& pose, const glm::dvec3& direction) {
  query::World queries(world, registry);
  query::Ray ray;
  ray.origin = pose.position;
  ray.direction = direction;
  ray.longest_m = kFarM;
  const auto hit = queries.cast(ray);
  if (!hit || hit->kind == query::HitKind::kNothing) return std::nullopt;
  Selection selection{hit->kind, hit->block,    hit->index, hit->model,
                      {},        hit->position, {},         hit->distance_m};
  if (hit->kind == query::HitKind::kModel) {
    const auto placed = queries.placement(hit->block, hit->index);
    if (!placed) return std::nullopt;
    selection.parameters = placed->parameters;
    selection.at = {hit->block, glm::dvec3(placed->position)};
    selection.box = registry[hit->model].bounds(placed->parameters);
  } else {
    selection.model = world.terrain_model;
    selection.parameters = world::terrain_parameters(world, hit->block);
  }
  return selection;
}

}  // namespace psygen::editor
