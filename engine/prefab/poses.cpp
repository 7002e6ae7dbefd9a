#include "engine/prefab/poses.hpp"

#include <glm/geometric.hpp>

#include "engine/gltf/animation.hpp"

namespace psygen::prefab {
namespace {

using scene::FixedStep;
using scene::Transform;

void pose_nodes(const PoseQuery& entities, const Prefab& prefab, const FixedStep& step,
                std::span<const ecs::Entity> nodes, Instance& instance) {
  const auto attached = entities.accessor<Attached>();
  if (!instance.rests) {
    for (std::size_t i = 0; i < prefab.nodes.size(); ++i) {
      if (Attached* node = attached.get(nodes[i])) node->pose = prefab.nodes[i].rest;
    }
    instance.rests = true;
  }
  const gltf::Animation& animation = prefab.animations[instance.animation];
  const float time_s = place_in(animation, animation_time_s(instance, step), instance.loops);
  for (const gltf::Channel& channel : animation.channels) {
    if (Attached* node = attached.get(nodes[channel.node])) apply(channel, time_s, node->pose);
  }
}

glm::mat3 scaled(const glm::quat& rotation, const glm::vec3& scale) {
  glm::mat3 basis = glm::mat3_cast(rotation);
  for (int axis = 0; axis < 3; ++axis)
    basis[axis] *= scale[axis];
  return basis;
}

// Computes the rotation and the scale nearest to these axes.
void decompose(const glm::mat3& basis, Transform& out) {
  for (int axis = 0; axis < 3; ++axis)
    out.scale[axis] = glm::length(basis[axis]);
  if (!(out.scale.x > 0 && out.scale.y > 0 && out.scale.z > 0)) return;  // not drawn
  if (glm::determinant(basis) < 0) out.scale.x = -out.scale.x;
  const glm::vec3 x = basis[0] / out.scale.x;
  const glm::vec3 z = glm::normalize(glm::cross(x, basis[1]));
  out.rotation = glm::quat_cast(glm::mat3(x, glm::cross(z, x), z));
}

class Composer {
 public:
  Composer(const PoseQuery& entities, std::uint32_t tick)
      : attached_(entities.accessor<Attached>()),
        transforms_(entities.accessor<Transform>()),
        tick_(tick) {}

  // Places an entity after all its ancestors that this tick has not placed yet.
  void place(ecs::Entity entity) {
    chain_.clear();
    Attached* node = attached_.get(entity);
    while (node != nullptr && node->state.tick != tick_) {
      node->state.tick = tick_;
      chain_.push_back(entity);
      entity = node->parent;
      node = attached_.get(entity);
    }
    for (std::size_t i = chain_.size(); i > 0; --i)
      place_one(chain_[i - 1]);
  }

 private:
  void place_one(ecs::Entity entity) {
    Attached& node = *attached_.get(entity);
    const Transform* parent = transforms_.get(node.parent);
    Transform* own = transforms_.get(entity);
    if (parent == nullptr || own == nullptr) return;
    const Attached* above = attached_.get(node.parent);
    const glm::mat3 basis = above != nullptr
                                ? above->state.basis
                                : scaled(glm::normalize(parent->rotation), parent->scale);
    own->position = parent->position;
    own->position.local += glm::dvec3(basis * node.pose.translation);
    node.state.basis = basis * scaled(node.pose.rotation, node.pose.scale);
    decompose(node.state.basis, *own);
  }

  ecs::Accessor<Attached> attached_;
  ecs::Accessor<Transform> transforms_;
  std::uint32_t tick_;
  std::vector<ecs::Entity> chain_;
};

}  // namespace

void poses_system(const Library& library, const FixedStep& step, const scene::Clock& clock,
                  PoseQuery entities) {
  entities.each<Instance, const ecs::Children>([&](std::span<const ecs::Entity>,
                                                   std::span<Instance> instances,
                                                   std::span<const ecs::Children> children) {
    for (std::size_t i = 0; i < instances.size(); ++i) {
      Instance& instance = instances[i];
      if (!library.exists(instance.prefab)) continue;
      const Prefab& prefab = library[instance.prefab];
      const std::span<const ecs::Entity> nodes = entities.children(children[i]);
      if (instance.animation < prefab.animations.size() && nodes.size() >= prefab.nodes.size())
        pose_nodes(entities, prefab, step, nodes, instance);
    }
  });
  Composer composer(entities, clock.tick);
  entities.each<const Attached>([&](std::span<const ecs::Entity> rows, std::span<const Attached>) {
    for (const ecs::Entity entity : rows)
      composer.place(entity);
  });
}

}  // namespace psygen::prefab
