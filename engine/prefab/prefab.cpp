#include "engine/prefab/prefab.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <span>
#include <utility>

#include "engine/core/log.hpp"
#include "engine/gltf/animation.hpp"
#include "engine/gltf/read_file.hpp"

namespace psygen::prefab {
namespace {

using scene::FixedStep;
using scene::Object;
using scene::Transform;

// Adds the content of a file to the assets, each object once.
class Adder {
 public:
  Adder(const gltf::Model& model, scene::Assets& assets) : model_(model), assets_(assets) {}

  // Removes its meshes again if it fails.
  core::Result<Prefab> add() {
    auto prefab = add_all();
    if (prefab) return prefab;
    for (const std::vector<Object>& objects : objects_)
      for (const Object& object : objects)
        assets_.remove_mesh(object.mesh);
    return prefab;
  }

 private:
  core::Result<Prefab> add_all() {
    Prefab prefab{model_.name, model_.nodes, model_.animations, {}};
    for (const gltf::Material& material : model_.materials) {
      auto added = add_material(material);
      if (!added) return tl::unexpected(added.error());
      materials_.push_back(*added);
    }
    objects_.resize(model_.meshes.size());
    for (std::uint32_t i = 0; i < model_.nodes.size(); ++i) {
      const std::uint32_t mesh = model_.nodes[i].mesh;
      if (mesh == gltf::kNone) continue;
      if (auto ok = add_mesh(mesh); !ok) return tl::unexpected(ok.error());
      for (const Object& object : objects_[mesh])
        prefab.parts.push_back({i, object});
    }
    return prefab;
  }

  core::Result<render::TextureId> add_texture(std::uint32_t image, bool colours) {
    if (image == gltf::kNone) return render::kNoTexture;
    const auto [at, is_new] = textures_.try_emplace({image, colours}, render::kNoTexture);
    if (!is_new) return at->second;
    const auto texture = assets_.add_texture(*model_.images[image], colours);
    if (texture) at->second = *texture;
    return texture;
  }

  core::Result<render::MaterialId> add_material(const gltf::Material& from) {
    const auto base = add_texture(from.base_texture, true);
    if (!base) return tl::unexpected(base.error());
    const auto normal = add_texture(from.normal_texture, false);
    if (!normal) return tl::unexpected(normal.error());
    const auto light = add_texture(from.emissive_texture, true);
    if (!light) return tl::unexpected(light.error());
    return assets_.add_material({.base_colour = from.base_colour,
                                 .opacity = from.opacity,
                                 .min_opacity = from.min_opacity,
                                 .emissive = from.emissive,
                                 .base_texture = *base,
                                 .normal_texture = *normal,
                                 .emissive_texture = *light,
                                 .normal_strength = from.normal_strength,
                                 .two_sided = from.two_sided});
  }

  core::Result<void> add_mesh(std::uint32_t index) {
    const gltf::Mesh& mesh = model_.meshes[index];
    if (!objects_[index].empty()) return {};
    for (const gltf::Primitive& primitive : mesh.primitives) {
      const bool fits = primitive.mesh.positions.size() <= core::kMaxMeshVertices;
      const auto parts = fits ? std::vector<core::MeshData>{} : core::split(primitive.mesh);
      const std::span<const core::MeshData> all =
          fits ? std::span(&primitive.mesh, 1) : std::span(parts);
      for (const core::MeshData& part : all) {
        const auto added = assets_.add_mesh(part, fmt::format("{}: {}", model_.name, mesh.name));
        if (!added) return tl::unexpected(added.error());
        Object& object = objects_[index].emplace_back();
        object.mesh = *added;
        if (primitive.material != gltf::kNone) object.material = materials_[primitive.material];
      }
    }
    return {};
  }

  const gltf::Model& model_;
  scene::Assets& assets_;
  std::map<std::pair<std::uint32_t, bool>, render::TextureId> textures_;
  std::vector<render::MaterialId> materials_;
  std::vector<std::vector<Object>> objects_;  // of each mesh of the file
};

using PoseQuery = ecs::Query<const ecs::Children, Instance, Attached, Transform>;

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

// True if scale and rotation alone do not give these axes.
bool is_sheared(const glm::mat3& basis) {
  constexpr float kSkew = 1e-3F;
  for (int axis = 0; axis < 3; ++axis) {
    const glm::vec3 &a = basis[axis], &b = basis[(axis + 1) % 3];
    if (std::abs(glm::dot(a, b)) > kSkew * glm::length(a) * glm::length(b)) return true;
  }
  return false;
}

// A warning that names a node whose shape the system "poses" cannot draw, in its rest pose or at a
// key of its rotation; empty: there is none.
std::string shear_of(const gltf::Model& model) {
  std::uint32_t sheared = gltf::kNone;
  std::vector<glm::mat3> parents, bases;
  for (std::uint32_t i = 0; i < model.nodes.size(); ++i) {
    const gltf::Node& node = model.nodes[i];
    parents.push_back(node.parent == gltf::kNone ? glm::mat3(1.0F) : bases[node.parent]);
    bases.push_back(parents[i] * scaled(node.rest.rotation, node.rest.scale));
    if (is_sheared(bases[i])) sheared = std::min(sheared, i);
  }
  for (const gltf::Animation& animation : model.animations) {
    for (const gltf::Channel& channel : animation.channels) {
      if (channel.property != gltf::Property::kRotation) continue;
      gltf::Pose pose = model.nodes[channel.node].rest;
      for (const float time_s : channel.times_s) {
        apply(channel, time_s, pose);
        if (is_sheared(parents[channel.node] * scaled(pose.rotation, pose.scale)))
          sheared = std::min(sheared, channel.node);
      }
    }
  }
  if (sheared == gltf::kNone) return {};
  return fmt::format(
      "{}: node {} \"{}\" is turned below a parent with different scales per axis, which shears "
      "it; a prefab draws it without the shear (apply the scale in the modeler)",
      model.name, sheared, model.nodes[sheared].name);
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

// The system "poses": plays the animations of instances, then places Attached entities, parents
// first. Accepts entities in any order and at any depth; O(Attached + keys found).
void poses_system(const Library& library, const FixedStep& step, const scene::Clock& clock,
                  PoseQuery entities) {
  entities.each<Instance, const ecs::Children>([&](auto, auto instances, auto children) {
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
  entities.each<const Attached>([&](auto rows, auto) {
    for (const ecs::Entity entity : rows)
      composer.place(entity);
  });
}

}  // namespace

core::Result<void> Library::add_systems(scene::Systems& systems) {
  systems.frame.provide(*this);
  systems.frame.add("poses", poses_system, ecs::before("objects"));
  return {};
}

core::Result<PrefabId> Library::add(scene::Assets& assets, const gltf::Model& model) {
  if (const std::string warning = shear_of(model); !warning.empty()) core::log_warning(warning);
  auto prefab = Adder(model, assets).add();
  if (!prefab) {
    return core::fail(prefab.error().code,
                      fmt::format("{}: {}", model.name, prefab.error().message));
  }
  prefabs_.push_back(std::make_unique<const Prefab>(std::move(*prefab)));
  return PrefabId{static_cast<std::uint32_t>(prefabs_.size() - 1)};
}

core::Result<PrefabId> Library::load(scene::Assets& assets, const std::filesystem::path& file) {
  return gltf::read_file(file).and_then([&](const gltf::Model& model) {
    for (const std::string& note : model.notes)
      core::log_warning(note);
    return add(assets, model);
  });
}

ecs::Entity Library::spawn(ecs::World& world, PrefabId id, const Transform& transform) const {
  const Prefab& prefab = (*this)[id];
  const auto made = world.create<Transform, Instance, ecs::Children>(1);
  const ecs::Entity root = made.entities[0];
  made.column<Transform>()[0] = transform;
  made.column<Instance>()[0].prefab = id;
  const std::size_t nodes = prefab.nodes.size();
  std::vector<bool> has_object(nodes);
  std::size_t more = 0;  // parts after the first one of a node
  for (const Prefab::Part& part : prefab.parts) {
    more += has_object[part.node] ? 1 : 0;
    has_object[part.node] = true;
  }
  const auto parts = world.create<Transform, Object, Attached>(nodes + more);
  const std::span<Attached> attached = parts.column<Attached>();
  const std::span<Object> objects = parts.column<Object>();
  std::ranges::fill(parts.column<Transform>(), transform);
  for (std::size_t i = 0; i < nodes; ++i) {
    const gltf::Node& node = prefab.nodes[i];
    attached[i].parent = node.parent == gltf::kNone ? root : parts.entities[node.parent];
    attached[i].pose = node.rest;
    has_object[i] = false;
  }
  std::size_t next = nodes;
  for (const Prefab::Part& part : prefab.parts) {
    const std::size_t at = has_object[part.node] ? next++ : part.node;
    has_object[part.node] = true;
    objects[at] = part.object;
    if (at != part.node) attached[at].parent = parts.entities[part.node];
  }
  const std::vector<ecs::Entity> children(parts.entities.begin(), parts.entities.end());
  world.set_children(root, children);
  return root;
}

core::Result<void> Library::play(Instance& instance, std::string_view animation,
                                 const scene::FixedStep& step, const Playback& how) const {
  const Prefab& prefab = (*this)[instance.prefab];
  const auto found = std::ranges::find(prefab.animations, animation, &gltf::Animation::name);
  if (found == prefab.animations.end()) {
    std::string names;
    for (const gltf::Animation& one : prefab.animations)
      names += (names.empty() ? "" : ", ") + one.name;
    return core::invalid_argument(fmt::format("{} has no animation \"{}\"; its animations are {}",
                                              prefab.name, animation,
                                              names.empty() ? "none" : names));
  }
  instance.animation = static_cast<std::uint32_t>(found - prefab.animations.begin());
  instance.speed = how.speed;
  instance.loops = how.loops;
  instance.from_s = how.from_s;
  instance.since_step = step.index;
  instance.rests = false;
  return {};
}

double animation_time_s(const Instance& instance, const scene::FixedStep& step) {
  const double steps = static_cast<double>(step.index - instance.since_step) - 1 + step.share;
  return instance.from_s + instance.speed * step.step_s * std::max(steps, 0.0);
}

ecs::Entity Library::node_of(const ecs::World& world, ecs::Entity instance,
                             std::string_view name) const {
  const Instance* of = world.get<Instance>(instance);
  if (of == nullptr || !exists(of->prefab)) return ecs::kNullEntity;
  const std::vector<gltf::Node>& nodes = (*this)[of->prefab].nodes;
  const auto found = std::ranges::find(nodes, name, &gltf::Node::name);
  if (found == nodes.end()) return ecs::kNullEntity;
  const std::span<const ecs::Entity> children = world.children(instance);
  const auto i = static_cast<std::size_t>(found - nodes.begin());
  return i < children.size() && world.alive(children[i]) ? children[i] : ecs::kNullEntity;
}

}  // namespace psygen::prefab
