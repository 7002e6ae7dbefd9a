// The meshes, textures and materials of a scene's objects, by number. They live as long as the
// scene, meshes until they are removed. The vertices of copied meshes stay with the host; what is
// drawn lies in the geometry memory, is charged to the byte budget and may be evicted and copied
// again. Main thread only.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/mesh_data.hpp"
#include "engine/image/image.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/objects/components.hpp"
#include "engine/scene/objects/object_type.hpp"
#include "engine/synthesis/mesh_supply.hpp"

namespace psygen::scene {

// One level of detail of a mesh, as objects_system keeps it.
struct ObjectMeshLevel {
  synthesis::MeshKey key;
  synthesis::MeshHandle handle;
  core::GeometryRange range;  // if `ready`
  float error_m = 0;
  float nearest_m = 0;                 // distance of the nearest object that uses it, in `tick`
  float hole_m = 0;                    // of the nearest that can draw nothing instead
  std::uint32_t tick = UINT32_MAX;     // the last one in which an object used it
  bool ready = false, failed = false;  // in `tick`
  bool seen = false, hole = false;     // by an object in view
};

// One mesh.
struct ObjectMesh {
  static constexpr std::size_t kMaxLevels = 8;
  MeshId id;  // none: it was removed
  core::Bounds box;
  models::Parameters parameters;
  std::uint32_t level_count = 0;
  std::array<ObjectMeshLevel, kMaxLevels> levels;
};

class Assets {
 public:
  // For a scene with this registry, to which it adds the types of object meshes. `renderer` may be
  // null. Both outlive it. Once. Fails like Registry::add().
  core::Result<void> open(models::Registry& registry, render::Renderer* renderer);

  // Adds the same types to another registry, which is about to take the place of the one of open().
  // Meshes of objects are the same, under other keys. Those of model types keep their types, which
  // must live on.
  core::Result<void> follow(models::Registry& registry);

  // A mesh of the program's own, or of a file, and the levels of detail that are made of it, of
  // which each object takes one by its distance. Takes about 0.5 ms for 1,000 triangles: add large
  // ones while a game loads. `name` is for messages. Fails like scene::pack(),
  // and with kOverBudget beyond 65,536 meshes at a time.
  core::Result<MeshId> add_mesh(const core::MeshData& mesh, std::string name = "mesh");
  // The mesh of a model type ("tree", "rock", or one of a plugin), made by modelers when it is
  // needed. `level_count` levels of detail from `first_level` on, of which each object takes one by
  // its distance; 0: all that there are. Fails with kInvalidArgument for unknown types, terrain,
  // parameters that models::validate() refuses and levels that do not exist.
  core::Result<MeshId> add_model(std::string_view type, const models::Parameters& parameters,
                                 int first_level = 0, int level_count = 0);
  // Removes a mesh. Objects with it are not drawn from the next tick on, and do not fade. Host
  // memory is freed once no modeler uses it, geometry memory in a later tick. Its name is never
  // used again. Ignores meshes that do not exist.
  void remove_mesh(MeshId mesh);
  // A picture as a texture; `colours`: else numbers, as normal maps have. Fails like
  // Renderer::add_texture(). Without a renderer it only gets a number.
  core::Result<render::TextureId> add_texture(const image::Image& picture, bool colours = true);
  // Fails like Renderer::add_material(). Without a renderer it only gets a number.
  core::Result<render::MaterialId> add_material(const render::Material& material);

  bool exists(MeshId mesh) const {
    return slot_of(mesh) < meshes_.size() && meshes_[slot_of(mesh)].id == mesh && mesh != MeshId{};
  }
  std::size_t mesh_count() const { return count_; }
  // The box of a mesh that exists, in metres from its origin.
  const core::Bounds& box(MeshId mesh) const { return meshes_[slot_of(mesh)].box; }

  // The engine's: what a mesh has, and the wants of those that lack something (cache_system).
  ObjectMesh& mesh(MeshId mesh) { return meshes_[slot_of(mesh)]; }
  void want_all(synthesis::MeshSupply& meshes) const;
  // Gives back what the cache has of meshes that were removed, or that have other keys now.
  void forget_removed(synthesis::MeshSupply& meshes);
  // Meshes that objects used in the last tick, for objects_system.
  std::vector<std::pair<MeshId, std::uint32_t>> used, used_before;  // mesh, level

 private:
  static std::uint32_t slot_of(MeshId mesh) { return mesh.index % ObjectSources::kMax; }
  core::Result<MeshId> add(ObjectSource source, models::ModelIndex type);
  core::Result<void> add_types(models::Registry& registry);

  std::shared_ptr<ObjectSources> sources_;
  const models::Registry* registry_ = nullptr;
  models::ModelIndex copied_ = 0, synthesised_ = 0;
  render::Renderer* renderer_ = nullptr;
  std::uint32_t textures_ = 0, materials_ = 0;  // without a renderer
  std::vector<ObjectMesh> meshes_;              // by slot
  std::size_t count_ = 0;                       // of those that were not removed
  std::vector<synthesis::MeshKey> removed_;     // what the cache may have of those
};

}  // namespace psygen::scene
