#include "game/show/shapes.hpp"

#include "engine/core/mesh_shapes.hpp"

namespace cairns {
namespace {

using core::add_ellipsoid, core::add_triangle;

std::array<Part, kParts> deer() {
  const glm::vec3 coat(0.19F, 0.105F, 0.05F), pale(0.42F, 0.33F, 0.24F), dark(0.06F, 0.04F, 0.03F);
  std::array<Part, kParts> parts;
  core::MeshData& body = parts[0].mesh;
  add_ellipsoid(body, {0, 0.92F, 0}, {0.21F, 0.25F, 0.55F}, coat, pale);
  add_ellipsoid(body, {0, 1.17F, -0.55F}, {0.10F, 0.30F, 0.13F}, coat, coat);
  add_ellipsoid(body, {0, 1.42F, -0.70F}, {0.085F, 0.10F, 0.19F}, coat, pale);
  add_ellipsoid(body, {0, 1.03F, 0.54F}, {0.07F, 0.09F, 0.06F}, pale, pale);
  for (const float side : {-1.0F, 1.0F}) {
    add_triangle(body,
                 {glm::vec3(side * 0.04F, 1.48F, -0.62F),
                  {side * 0.16F, 1.58F, -0.58F},
                  {side * 0.07F, 1.50F, -0.56F}},
                 coat);
    add_triangle(body,
                 {glm::vec3(side * 0.03F, 1.50F, -0.66F),
                  {side * 0.17F, 1.85F, -0.60F},
                  {side * 0.06F, 1.50F, -0.62F}},
                 dark);
  }
  // Diagonal legs swing together.
  const auto leg = [&](core::MeshData& mesh, float x, float z) {
    add_ellipsoid(mesh, {x, -0.10F, z}, {0.07F, 0.26F, 0.09F}, coat, coat);
    add_ellipsoid(mesh, {x, -0.50F, z}, {0.04F, 0.34F, 0.045F}, coat, dark);
  };
  for (std::size_t pair = 1; pair < kParts; ++pair) {
    const float side = pair == 1 ? 1.0F : -1.0F;
    leg(parts[pair].mesh, side * 0.12F, -0.38F);
    leg(parts[pair].mesh, -side * 0.12F, 0.38F);
    parts[pair].joint = {0, 0.84F, 0};
    parts[pair].swing = 0.20F;
  }
  return parts;
}

std::array<Part, kParts> bird() {
  const glm::vec3 back(0.035F, 0.035F, 0.045F), breast(0.30F, 0.28F, 0.25F);
  std::array<Part, kParts> parts;
  add_ellipsoid(parts[0].mesh, {0, 0, 0}, {0.07F, 0.07F, 0.19F}, back, breast);
  add_ellipsoid(parts[0].mesh, {0, 0.05F, -0.20F}, {0.05F, 0.05F, 0.07F}, back, breast);
  add_triangle(parts[0].mesh, {glm::vec3(0, 0, 0.1F), {-0.09F, 0, 0.36F}, {0.09F, 0, 0.36F}}, back);
  for (std::size_t wing = 1; wing < kParts; ++wing) {
    const float side = wing == 1 ? 1.0F : -1.0F;
    core::MeshData& mesh = parts[wing].mesh;
    add_triangle(mesh, {glm::vec3(0, 0, -0.11F), {side * 0.30F, 0, -0.13F}, {0, 0, 0.13F}}, back);
    add_triangle(
        mesh, {glm::vec3(side * 0.30F, 0, -0.13F), {side * 0.58F, 0, 0.08F}, {0, 0, 0.13F}}, back);
    parts[wing].joint = {side * 0.05F, 0.03F, 0};
    parts[wing].axis = {0, 0, 1};
    parts[wing].swing = 0.75F;
  }
  return parts;
}

std::array<Part, kParts> fish() {
  const glm::vec3 back(0.10F, 0.12F, 0.10F), belly(0.50F, 0.50F, 0.44F);
  std::array<Part, kParts> parts;
  add_ellipsoid(parts[0].mesh, {0, 0, -0.04F}, {0.045F, 0.09F, 0.21F}, back, belly);
  add_triangle(parts[1].mesh, {glm::vec3(0, 0, 0), {0, 0.10F, 0.17F}, {0, -0.10F, 0.17F}}, back);
  parts[1].joint = {0, 0, 0.13F};
  parts[1].axis = {0, 1, 0};
  parts[1].swing = 0.6F;
  return parts;
}

}  // namespace

std::array<Part, kParts> parts_of(Kind kind) {
  return kind == Kind::kDeer ? deer() : kind == Kind::kBird ? bird() : fish();
}

}  // namespace cairns
