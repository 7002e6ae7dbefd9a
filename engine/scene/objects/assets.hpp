// The meshes, textures and materials of a scene's objects, by number. They live as long as the
// scene, meshes until they are removed. The host keeps the vertices of copied meshes. Drawn copies
// lie in the geometry memory, count against the byte budget, and may be evicted and copied again.
// Main thread only.
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

// One LOD of a mesh, with the state that objects_system() keeps.
struct ObjectMeshLevel {
  synthesis::MeshKey key;
  synthesis::MeshHandle handle;
  core::GeometryRange range;  // if `ready`
  float error_m = 0;
  float nearest_m = 0;              // distance of the nearest object that uses it, in `tick`
  float hole_m = 0;                 // distance of the nearest object that has no other LOD to draw
  std::uint32_t tick = UINT32_MAX;  // the last tick in which an object used it
  bool ready = false, failed = false;  // in `tick`
  bool seen = false, hole = false;     // by an object in view
};

// One mesh.
struct ObjectMesh {
  static constexpr std::size_t kMaxLevels = 8;
  MeshId id;  // invalid: it was removed
  core::Bounds box;
  models::Parameters parameters;
  std::uint32_t level_count = 0;
  std::array<ObjectMeshLevel, kMaxLevels> levels;
};

class Assets {
 public:
  // Opens the assets of a scene and adds the types of object meshes to its registry. Call it once.
  // `renderer` may be null; both must outlive the assets. `budget_bytes` limits the vertices and
  // indices that the host keeps. Fails as Registry::add().
  core::Result<void> open(models::Registry& registry, render::Renderer* renderer,
                          std::uint64_t budget_bytes);

  // Adds the same types to the registry that will replace the one of open(). Object meshes stay,
  // under other keys. Meshes of model types keep their types, which must live on.
  core::Result<void> follow(models::Registry& registry);

  // Adds a mesh from code or from a file, with LODs made from it; each object uses one by its
  // distance. Takes about 0.5 ms for 1,000 triangles: add large meshes while a game loads. `name`
  // is for messages. Fails as scene::pack(), and with kOverBudget beyond 65,536 meshes at a time
  // or the budget of open().
  core::Result<MeshId> add_mesh(const core::MeshData& mesh, std::string name = "mesh");
  // Adds the mesh of a model type ("tree", "rock", or a plugin's), synthesised by modelers on
  // demand. `level_count` LODs from `first_level` on, of which each object uses one by its
  // distance; 0: all. Fails with kInvalidArgument for unknown types, terrain, parameters that
  // models::validate() rejects, and levels that do not exist.
  core::Result<MeshId> add_model(std::string_view type, const models::Parameters& parameters,
                                 int first_level = 0, int level_count = 0);
  // Removes a mesh. Its objects are not drawn from the next tick on, without a fade. Host memory is
  // freed once no modeler uses it, geometry memory in a later tick. Its number is never used again.
  // Ignores meshes that do not exist.
  void remove_mesh(MeshId mesh);
  // Adds an image as a texture. `colours`: false for data such as normal maps. Fails as
  // Renderer::add_texture(). Without a renderer it only gets a number.
  core::Result<render::TextureId> add_texture(const image::Image& picture, bool colours = true);
  // Adds a material. Fails as Renderer::add_material(). Without a renderer it only gets a number.
  core::Result<render::MaterialId> add_material(const render::Material& material);

  bool exists(MeshId mesh) const {
    return slot_of(mesh) < meshes_.size() && meshes_[slot_of(mesh)].id == mesh && mesh != MeshId{};
  }
  std::size_t mesh_count() const { return count_; }
  // The bounds of an existing mesh, in metres from its origin.
  const core::Bounds& box(MeshId mesh) const { return meshes_[slot_of(mesh)].box; }

  // For the engine: a mesh, and the wants of meshes with missing LODs (cache_system).
  ObjectMesh& mesh(MeshId mesh) { return meshes_[slot_of(mesh)]; }
  void want_all(synthesis::MeshSupply& meshes) const;
  // Evicts the cached meshes that were removed, or that have other keys now.
  void forget_removed(synthesis::MeshSupply& meshes);
  // Meshes that objects used in the last ticks, for objects_system().
  std::vector<std::pair<MeshId, std::uint32_t>> used, used_before;  // mesh, level

 private:
  static std::uint32_t slot_of(MeshId mesh) { return mesh.index % ObjectSources::kMax; }
  core::Result<MeshId> add(ObjectSource source, models::ModelIndex type);
  core::Result<void> add_types(models::Registry& registry);
  // Fails with kOverBudget if a mesh of this size would exceed the budget.
  core::Result<void> check_budget(std::string_view name, std::uint64_t bytes) const;

  std::shared_ptr<ObjectSources> sources_;
  const models::Registry* registry_ = nullptr;
  models::ModelIndex copied_ = 0, synthesised_ = 0;
  render::Renderer* renderer_ = nullptr;
  std::uint32_t textures_ = 0, materials_ = 0;  // without a renderer
  std::vector<ObjectMesh> meshes_;              // by slot
  std::size_t count_ = 0;                       // of meshes that exist
  std::uint64_t budget_bytes_ = 0, bytes_ = 0;  // of copied meshes; bytes_: of those that exist
  std::vector<synthesis::MeshKey> removed_;     // keys that the cache may still have
};

}  // namespace psygen::scene
