// Things made of several objects, from glTF files: a house with its door, a mill with its sails
// (docs/objects.md). A prefab is a file's content in a scene. spawn() puts an instance of it into
// the world: a root with a Transform, which moves the whole, and an entity for each node, which is
// Attached to another one. To remove it: world.destroy_with_children(). Main thread only.
#pragma once

#include <filesystem>
#include <glm/mat3x3.hpp>
#include <memory>
#include <string_view>
#include <vector>

#include "ecs/ecs.hpp"
#include "engine/gltf/model.hpp"
#include "engine/scene/objects/assets.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/simulation.hpp"

namespace psygen::prefab {

// A file's content in a scene.
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

// Names a prefab of a library.
struct PrefabId {
  std::uint32_t index = UINT32_MAX;  // UINT32_MAX: none
  friend bool operator==(const PrefabId&, const PrefabId&) = default;
};

// What the system "poses" keeps of an Attached entity.
struct AttachedState {
  glm::mat3 basis{1.0F};            // its axes in the world
  std::uint32_t tick = UINT32_MAX;  // the last one in which it was placed
};

// Holds an entity to another one. The system "poses" writes its Transform in every frame, from that
// of the parent, which may be Attached itself. An entity whose parent is dead or has no Transform
// stays where it is; parents in a circle stand somewhere. Where a parent has different scales for
// its axes, a turned child is scaled as well as possible, but not skewed.
struct Attached {
  ecs::Entity parent;
  gltf::Pose pose;  // relative to the parent
  AttachedState state = {};
};

// The component of an instance's root: what it plays. Its children are the entities of the nodes,
// in their order, and then those of further meshes. Library::play() writes it.
struct Instance {
  PrefabId prefab;
  std::uint32_t animation = gltf::kNone;  // of the prefab; kNone: nodes stay as they are
  float speed = 1;                        // of the animation's seconds a second; may be negative
  bool loops = true;
  bool rests = false;            // nodes had their rest poses since play() (the system "poses")
  double from_s = 0;             // of the animation, in step `since_step`
  std::uint64_t since_step = 0;  // FixedStep::index
};

}  // namespace psygen::prefab

// For snapshots (engine/scene/objects/described.hpp), as those below.
template <>
struct psygen::ecs::ComponentTraits<psygen::gltf::Pose> {
  static constexpr auto fields =
      std::tuple{field("translation", &gltf::Pose::translation),
                 field("rotation", &gltf::Pose::rotation), field("scale", &gltf::Pose::scale)};
};

// Its number.
template <>
struct psygen::ecs::ComponentTraits<psygen::prefab::PrefabId> {
  static constexpr auto fields = std::tuple{field("index", &prefab::PrefabId::index)};
};

// The parent and the pose to it; where it was drawn comes anew.
template <>
struct psygen::ecs::ComponentTraits<psygen::prefab::Attached> {
  static constexpr std::string_view name = "Attached";
  static constexpr auto fields = std::tuple{field("parent", &prefab::Attached::parent),
                                            field("pose", &prefab::Attached::pose)};
};

// Prefabs by their numbers: those of the same order of calls of Library. Steps count from the start
// of a session: call Library::play() after loading.
template <>
struct psygen::ecs::ComponentTraits<psygen::prefab::Instance> {
  static constexpr std::string_view name = "Instance";
  static constexpr auto fields = std::tuple{
      field("prefab", &prefab::Instance::prefab), field("animation", &prefab::Instance::animation),
      field("speed", &prefab::Instance::speed), field("loops", &prefab::Instance::loops),
      field("from_s", &prefab::Instance::from_s)};
};

namespace psygen::prefab {

// How an animation is played.
struct Playback {
  double from_s = 0;  // of the animation
  float speed = 1;
  bool loops = true;
};

// The seconds of its animation that an instance shows in this frame, before its loop or its end.
double animation_time_s(const Instance& instance, const scene::FixedStep& step);

// The prefabs of a scene. They live as long as it.
class Library {
 public:
  Library() = default;
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  // Adds the system "poses" to a scene, before "objects": it plays animations and places what is
  // Attached. What moves roots runs before it: call this last in Plugin::add_systems, or name the
  // place ecs::before("poses"). The library must outlive the scene.
  core::Result<void> add_systems(scene::Systems& systems);

  // A .glb or .gltf file with its meshes and materials. What it has and the engine does not is
  // logged. Fails like gltf::read_file() and add(). Too slow for the tick.
  core::Result<PrefabId> load(scene::Assets& assets, const std::filesystem::path& file);
  // The same for what was read, in another thread for example; it needs no more to be kept. Meshes
  // of more than 65,535 vertices become several. Fails like the functions of Assets; what was added
  // to them until then stays.
  core::Result<PrefabId> add(scene::Assets& assets, const gltf::Model& model);

  bool exists(PrefabId prefab) const { return prefab.index < prefabs_.size(); }
  // A prefab that exists. It never moves.
  const Prefab& operator[](PrefabId prefab) const { return *prefabs_[prefab.index]; }

  // A new instance of a prefab that exists: a root with Transform, Instance and ecs::Children, and
  // its parts.
  ecs::Entity spawn(ecs::World& world, PrefabId prefab, const scene::Transform& transform) const;
  // Starts an animation of an instance. Its time is that of the simulation: it follows from the
  // number of steps alone, and pictures lie between two of them. Fails with kInvalidArgument, and
  // says which animations there are.
  core::Result<void> play(Instance& instance, std::string_view animation,
                          const scene::FixedStep& step, const Playback& how = {}) const;
  // The entity of an instance's node, the first one of this name; null where there is none.
  ecs::Entity node_of(const ecs::World& world, ecs::Entity instance, std::string_view name) const;

 private:
  std::vector<std::unique_ptr<const Prefab>> prefabs_;
};

}  // namespace psygen::prefab
