#include "engine/prefab/prefab.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>
#include <utility>

#include "engine/core/log.hpp"
#include "engine/gltf/read_file.hpp"
#include "engine/prefab/poses.hpp"

namespace psygen::prefab {
namespace {

using scene::Object;
using scene::Transform;

// Adds the content of a file to the assets, each object once.
class Adder {
 public:
  Adder(const gltf::Model& model, scene::Assets& assets) : model_(model), assets_(assets) {}

  core::Result<Prefab> add() {
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

 private:
  core::Result<render::TextureId> add_texture(std::uint32_t image, bool colours) {
    if (image == gltf::kNone) return render::kNoTexture;
    const auto [at, is_new] = textures_.try_emplace({image, colours}, render::kNoTexture);
    if (!is_new) return at->second;
    const auto texture = assets_.add_texture(model_.images[image], colours);
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

}  // namespace

core::Result<void> Library::add_systems(scene::Systems& systems) {
  systems.frame.provide(*this);
  systems.frame.add("poses", poses_system, ecs::before("objects"));
  return {};
}

core::Result<PrefabId> Library::add(scene::Assets& assets, const gltf::Model& model) {
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
    return core::fail(core::ErrorCode::kInvalidArgument,
                      fmt::format("{} has no animation \"{}\"; its animations are {}", prefab.name,
                                  animation, names.empty() ? "none" : names));
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
  return world.children(instance)[static_cast<std::size_t>(found - nodes.begin())];
}

}  // namespace psygen::prefab
