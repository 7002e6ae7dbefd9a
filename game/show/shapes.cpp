#include "game/show/shapes.hpp"

#include <cmath>
#include <numbers>

namespace cairns {
namespace {

constexpr int kAround = 8, kUp = 5;

void add_ellipsoid(core::MeshData& mesh, const glm::vec3& middle, const glm::vec3& half,
                   const glm::vec3& above, const glm::vec3& below) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (int up = 0; up <= kUp; ++up) {
    const float v = std::numbers::pi_v<float> * (static_cast<float>(up) / kUp - 0.5F);
    for (int side = 0; side < kAround; ++side) {
      const float u = 2 * std::numbers::pi_v<float> * static_cast<float>(side) / kAround;
      const glm::vec3 way(std::cos(v) * std::cos(u), std::sin(v), std::cos(v) * std::sin(u));
      mesh.positions.push_back(middle + half * way);
      mesh.normals.push_back(way / half);
      mesh.colours.push_back(way.y < -0.2F ? below : above);
    }
  }
  for (std::uint32_t up = 0; up < kUp; ++up) {
    for (std::uint32_t side = 0; side < kAround; ++side) {
      const std::uint32_t next = (side + 1) % kAround, low = first + up * kAround,
                          high = low + kAround;
      for (const std::uint32_t i :
           {low + side, high + side, high + next, low + side, high + next, low + next})
        mesh.indices.push_back(i);
    }
  }
}

// A triangle that is seen from both sides.
void add_fin(core::MeshData& mesh, const std::array<glm::vec3, 3>& corners,
             const glm::vec3& colour) {
  const glm::vec3 a = corners[1] - corners[0], b = corners[2] - corners[0];
  const glm::vec3 normal(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
  for (const glm::vec3& corner : corners) {
    mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
    mesh.positions.push_back(corner);
    mesh.normals.push_back(normal.y < 0 ? -normal : normal);
    mesh.colours.push_back(colour);
  }
}

std::array<Part, kParts> deer() {
  const glm::vec3 coat(0.19F, 0.105F, 0.05F), pale(0.42F, 0.33F, 0.24F), dark(0.06F, 0.04F, 0.03F);
  std::array<Part, kParts> parts;
  core::MeshData& body = parts[0].mesh;
  add_ellipsoid(body, {0, 0.92F, 0}, {0.21F, 0.25F, 0.55F}, coat, pale);
  add_ellipsoid(body, {0, 1.17F, -0.55F}, {0.10F, 0.30F, 0.13F}, coat, coat);
  add_ellipsoid(body, {0, 1.42F, -0.70F}, {0.085F, 0.10F, 0.19F}, coat, pale);
  add_ellipsoid(body, {0, 1.03F, 0.54F}, {0.07F, 0.09F, 0.06F}, pale, pale);
  for (const float side : {-1.0F, 1.0F}) {
    add_fin(body,
            {glm::vec3(side * 0.04F, 1.48F, -0.62F),
             {side * 0.16F, 1.58F, -0.58F},
             {side * 0.07F, 1.50F, -0.56F}},
            coat);
    add_fin(body,
            {glm::vec3(side * 0.03F, 1.50F, -0.66F),
             {side * 0.17F, 1.85F, -0.60F},
             {side * 0.06F, 1.50F, -0.62F}},
            dark);
  }
  // Legs that swing together are diagonal ones.
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
  add_fin(parts[0].mesh, {glm::vec3(0, 0, 0.1F), {-0.09F, 0, 0.36F}, {0.09F, 0, 0.36F}}, back);
  for (std::size_t wing = 1; wing < kParts; ++wing) {
    const float side = wing == 1 ? 1.0F : -1.0F;
    core::MeshData& mesh = parts[wing].mesh;
    add_fin(mesh, {glm::vec3(0, 0, -0.11F), {side * 0.30F, 0, -0.13F}, {0, 0, 0.13F}}, back);
    add_fin(mesh, {glm::vec3(side * 0.30F, 0, -0.13F), {side * 0.58F, 0, 0.08F}, {0, 0, 0.13F}},
            back);
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
  add_fin(parts[1].mesh, {glm::vec3(0, 0, 0), {0, 0.10F, 0.17F}, {0, -0.10F, 0.17F}}, back);
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
