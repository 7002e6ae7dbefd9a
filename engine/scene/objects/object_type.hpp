// Object meshes as model types, so that modelers make them and the cache ranks and evicts them like
// all others: a copied mesh (from code or a file), or the mesh of another model type with widened
// vertices. The only parameter is the number of the source.
//
// Modelers look sources up while the main thread adds and removes others. A source never changes,
// and lives while a modeler uses it.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "engine/models/registry.hpp"
#include "engine/scene/objects/packed_mesh.hpp"

namespace psygen::scene {

// The source of an object's mesh.
struct ObjectSource {
  std::string name;                         // for messages
  std::vector<ObjectLevel> copied;          // if `type` is null: level_count levels
  const models::ModelType* type = nullptr;  // null: the mesh is copied
  models::Parameters parameters;
  int first_level = 0;  // of the type
  int level_count = 1;
  core::Bounds box;
};

// All sources of a scene. Any thread.
class ObjectSources {
 public:
  static constexpr std::uint32_t kMax = 1 << 16;

  // Adds a source and returns its name; nothing if kMax exist. The lower 16 bits are a slot, reused
  // after remove(); the upper bits count its uses. No name occurs twice.
  std::optional<std::uint32_t> add(ObjectSource source);
  // Ignores unknown names.
  void remove(std::uint32_t name);
  // Returns the source, or null if the name is unknown or was removed.
  std::shared_ptr<const ObjectSource> find(std::uint32_t name) const;

 private:
  struct Slot {
    std::shared_ptr<const ObjectSource> source;
    std::uint32_t name = 0;  // of `source`, or of the slot's next source
  };
  mutable std::mutex mutex_;  // guards all members
  std::vector<Slot> slots_;
  std::vector<std::uint32_t> free_;
};

// The types of copied and of synthesised meshes. Only modelers synthesise.
std::unique_ptr<models::ModelType> make_object_type(std::shared_ptr<const ObjectSources> sources,
                                                    bool copied);

// The parameters of a source.
models::Parameters object_parameters(std::uint32_t name);

}  // namespace psygen::scene
