// The meshes of objects as model types, so that they are made by modelers, cached, ranked and
// evicted like all others: a copied mesh (of code or of a file), or the mesh of another model type
// with its vertices widened. Which mesh is meant is the only parameter.
//
// Modelers look entries up while the main thread adds and removes others. An entry never changes,
// and lives on while a modeler uses it.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "engine/models/registry.hpp"
#include "engine/scene/objects/object_levels.hpp"

namespace psygen::scene {

// Where the mesh of an object comes from.
struct ObjectSource {
  std::string name;                         // for messages
  std::vector<ObjectLevel> copied;          // if `type` is null: level_count of them
  const models::ModelType* type = nullptr;  // else it is synthesised
  models::Parameters parameters;
  int first_level = 0;  // of the type
  int level_count = 1;
  core::Bounds box;
};

// All of a scene. Any thread.
class ObjectSources {
 public:
  static constexpr std::uint32_t kMax = 1 << 16;

  // The name of a new entry; nothing if kMax exist. The lower 16 bits are a slot, which is
  // used again after remove(), the upper ones count how often it was. No name comes twice.
  std::optional<std::uint32_t> add(ObjectSource source);
  // Ignores unknown names.
  void remove(std::uint32_t name);
  // Null: there is no entry of this name, or it was removed.
  std::shared_ptr<const ObjectSource> find(std::uint32_t name) const;

 private:
  struct Slot {
    std::shared_ptr<const ObjectSource> source;
    std::uint32_t name = 0;  // of `source`, or of the next one
  };
  mutable std::mutex mutex_;  // guards all of it
  std::vector<Slot> slots_;
  std::vector<std::uint32_t> free_;
};

// The type of copied meshes, or that of synthesised ones, which only modelers make.
std::unique_ptr<models::ModelType> make_object_type(std::shared_ptr<const ObjectSources> sources,
                                                    bool copied);

// The parameters that name a source.
models::Parameters object_parameters(std::uint32_t name);

}  // namespace psygen::scene
