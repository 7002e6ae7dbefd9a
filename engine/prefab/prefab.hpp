// Models of several objects, from glTF files: a house with its door, a mill with its sails
// (docs/objects.md). A prefab is the content of a file in a scene. spawn() creates an instance in
// the world: a root with a Transform, which moves the whole instance, and an entity for each node,
// which is Attached to another one. To remove it: world.destroy_with_children(). Main thread only.
#pragma once

#include <filesystem>
#include <glm/mat3x3.hpp>
#include <memory>
#include <string_view>
#include <vector>

#include "ecs/ecs.hpp"
#include "engine/gltf/model.hpp"
#include "engine/scene/frame/clock.hpp"
#include "engine/scene/objects/assets.hpp"
#include "engine/scene/objects/components.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/systems.hpp"

namespace psygen::prefab {

// The content of a file in a scene.
struct Prefab {
  struct Part {
    std::uint32_t node = 0;
    scene::Object object;
  };
  std::string name;  // of the file
  std::vector<gltf::Node> nodes;
  std::vector<gltf::Animation> animations;
  std::vector<Part> parts;  // by node
};

// Identifies a prefab of a library.
struct PrefabId {
  std::uint32_t index = UINT32_MAX;  // UINT32_MAX: none
  friend bool operator==(const PrefabId&, const PrefabId&) = default;
};

// State of the system "poses" for an Attached entity.
struct AttachedState {
  glm::mat3 basis{1.0F};            // axes in the world
  std::uint32_t tick = UINT32_MAX;  // last tick in which it was placed
};

// Attaches an entity to another one. The system "poses" writes its Transform in every frame from
// that of the parent, which may be Attached itself. An entity whose parent is dead or has no
// Transform keeps its position; the position of entities in a cycle is unspecified. If a parent has
// different scales per axis, a rotated child is scaled approximately, but not skewed.
struct Attached {
  ecs::Entity parent;
  gltf::Pose pose;  // relative to the parent
  AttachedState state = {};
};

// Component of an instance's root: the animation that it plays. Its children are the entities of
// the nodes, in order, then those of further meshes. Library::play() writes it.
struct Instance {
  PrefabId prefab;
  std::uint32_t animation = gltf::kNone;  // of the prefab; kNone: nodes keep their poses
  float speed = 1;                        // animation seconds per second; may be negative
  bool loops = true;
  bool rests = false;  // nodes have had their rest poses since play() (the system "poses")
  double from_s = 0;   // position in the animation at step `since_step`
  std::uint64_t since_step = 0;  // FixedStep::index
};

}  // namespace psygen::prefab

// For snapshots (engine/scene/objects/components.hpp), as the traits below.
template <>
struct psygen::ecs::ComponentTraits<psygen::gltf::Pose> {
  static constexpr auto fields =
      std::tuple{field("translation", &gltf::Pose::translation),
                 field("rotation", &gltf::Pose::rotation), field("scale", &gltf::Pose::scale)};
};

// Saves its index.
template <>
struct psygen::ecs::ComponentTraits<psygen::prefab::PrefabId> {
  static constexpr auto fields = std::tuple{field("index", &prefab::PrefabId::index)};
};

// Saves the parent and the pose relative to it; the drawn position is recomputed.
template <>
struct psygen::ecs::ComponentTraits<psygen::prefab::Attached> {
  static constexpr std::string_view name = "Attached";
  static constexpr auto fields = std::tuple{field("parent", &prefab::Attached::parent),
                                            field("pose", &prefab::Attached::pose)};
};

// Saves prefabs by index, which depends on the order of calls to Library. Steps count from the
// start of a session: call Library::play() after loading.
template <>
struct psygen::ecs::ComponentTraits<psygen::prefab::Instance> {
  static constexpr std::string_view name = "Instance";
  static constexpr auto fields = std::tuple{
      field("prefab", &prefab::Instance::prefab), field("animation", &prefab::Instance::animation),
      field("speed", &prefab::Instance::speed), field("loops", &prefab::Instance::loops),
      field("from_s", &prefab::Instance::from_s)};
};

namespace psygen::prefab {

// Options of playing an animation.
struct Playback {
  double from_s = 0;  // start position in the animation
  float speed = 1;
  bool loops = true;
};

// Time in seconds within the animation that an instance shows in this frame, before looping or
// clamping.
double animation_time_s(const Instance& instance, const scene::FixedStep& step);

// The prefabs of a scene. They live as long as the scene.
class Library {
 public:
  Library() = default;
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  // Adds the system "poses" to a scene, before "objects": it plays animations and places Attached
  // entities. Systems that move roots must run before it: call this last in Plugin::add_systems, or
  // order them by ecs::before("poses"). The library must outlive the scene.
  core::Result<void> add_systems(scene::Systems& systems);

  // Loads a .glb or .gltf file with its meshes and materials. Logs unsupported content. Fails like
  // gltf::read_file() and add(). Too slow for the tick.
  core::Result<PrefabId> load(scene::Assets& assets, const std::filesystem::path& file);
  // Adds a parsed model, for example one read in another thread; the model need not be kept. Splits
  // meshes of more than 65,535 vertices. Fails like the functions of Assets; then its meshes
  // are removed again, but its textures and materials stay.
  core::Result<PrefabId> add(scene::Assets& assets, const gltf::Model& model);

  bool exists(PrefabId prefab) const { return prefab.index < prefabs_.size(); }
  // A prefab that exists. It never moves.
  const Prefab& operator[](PrefabId prefab) const { return *prefabs_[prefab.index]; }

  // Creates an instance of an existing prefab: a root with Transform, Instance and ecs::Children,
  // and its parts.
  ecs::Entity spawn(ecs::World& world, PrefabId prefab, const scene::Transform& transform) const;
  // Starts an animation of an instance. Its time depends only on the number of simulation steps;
  // frames interpolate between steps. Fails with kInvalidArgument and a message that lists the
  // animations.
  core::Result<void> play(Instance& instance, std::string_view animation,
                          const scene::FixedStep& step, const Playback& how = {}) const;
  // Entity of an instance's first node with this name; null if there is none, or it was destroyed.
  ecs::Entity node_of(const ecs::World& world, ecs::Entity instance, std::string_view name) const;

 private:
  std::vector<std::unique_ptr<const Prefab>> prefabs_;
};

}  // namespace psygen::prefab
