#include "engine/world/far/proxy_writer.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>

namespace psygen::world {

void ProxyWriter::add(Form form, const ProxyMesh& mesh, const glm::vec3& foot, bool sways) {
  const ProxySize size = size_of(form);
  for (std::size_t i = 0; i < 3 * std::size_t{size.triangles}; ++i)
    out_.indices[indices_++] = static_cast<std::uint16_t>(vertices_ + mesh.indices[i]);
  for (std::size_t i = 0; i < size.vertices; ++i)
    write(mesh.corners[i], foot, i < size.solid_vertices ? nullptr : &mesh.aside[i], sways);
}

void ProxyWriter::add(std::span<const std::byte> vertices, std::span<const std::uint16_t> indices,
                      const core::Bounds& own, const glm::vec3& foot, bool sways) {
  for (const std::uint16_t i : indices)
    out_.indices[indices_++] = static_cast<std::uint16_t>(vertices_ + i);
  for (core::ModelVertex v : core::vertices_of<core::ModelVertex>(vertices)) {
    if (!sways) v.sway = 0;
    write(foot + models::unpack_position(v, own), v);
  }
}

core::Bounds ProxyWriter::finish() {
  if (vertices_ == 0) {
    std::fill(out_.vertices.begin(), out_.vertices.end(), std::byte{0});
    low_ = high_ = {0, 0, 0};
  }
  constexpr std::size_t kSize = sizeof(core::ModelVertex);
  for (std::size_t at = std::max<std::size_t>(vertices_, 1) * kSize; at < out_.vertices.size();
       at += kSize)
    std::memcpy(out_.vertices.data() + at, out_.vertices.data(), kSize);
  std::fill(out_.indices.begin() + static_cast<std::ptrdiff_t>(indices_), out_.indices.end(),
            std::uint16_t{0});
  const auto place = [this](const std::array<std::int16_t, 3>& q) {
    return box_.centre() + box_.half_extent() * (glm::vec3(q[0], q[1], q[2]) * (1.0F / 32767.0F));
  };
  const glm::vec3 around(reach_m_, 0, reach_m_);  // inside the box, up to rounding
  return {glm::max(place(low_) - around, box_.min), glm::min(place(high_) + around, box_.max)};
}

// Shortens `aside` to the room in `box_` around `axis` in every direction.
glm::vec2 ProxyWriter::limited(glm::vec2 aside, const glm::vec3& axis) const {
  const float room = std::min(
      {axis.x - box_.min.x, box_.max.x - axis.x, axis.z - box_.min.z, box_.max.z - axis.z});
  const float reach = std::abs(aside.x) + std::abs(aside.y);
  return reach > room ? aside * (std::max(room, 0.0F) / reach) : aside;
}

void ProxyWriter::write(const Corner& c, const glm::vec3& foot, const glm::vec2* aside,
                        bool sways) {
  core::ModelVertex v{};
  for (std::size_t k = 0; k < 3; ++k)
    v.colour[k] = models::pack_unorm8(c.colour[static_cast<int>(k)]);
  const glm::vec2 normal = aside != nullptr
                               ? limited(*aside, foot + c.position) / core::kBillboardReachM
                               : models::encode_octahedral(c.normal);
  v.normal[0] = models::pack_snorm16(normal.x);
  v.normal[1] = models::pack_snorm16(normal.y);
  v.ambient = models::pack_unorm8(c.ambient);
  v.sway = sways ? models::pack_unorm8(c.sway) : std::uint8_t{0};
  v.material = aside != nullptr ? c.material | core::kBillboardBit : c.material;
  write(foot + c.position, v);
}

void ProxyWriter::write(const glm::vec3& place, core::ModelVertex v) {
  packer_.pack(place, v.position);
  for (std::size_t k = 0; k < 3; ++k) {
    low_[k] = std::min(low_[k], v.position[k]);
    high_[k] = std::max(high_[k], v.position[k]);
  }
  reach_m_ = std::max(reach_m_, core::billboard_reach_m(v));
  std::memcpy(out_.vertices.data() + vertices_++ * sizeof v, &v, sizeof v);
}

}  // namespace psygen::world
