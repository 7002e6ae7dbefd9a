// The meshes of objects as model types, so that they are made by modelers, cached, ranked and
// evicted like all others: a copied mesh (of code or of a file), or the mesh of another model type
// with its vertices widened. Which mesh is meant is the only parameter.
//
// The list of sources grows on the main thread. Modelers read those entries that a request names,
// which were written before the request was made. Entries never change or move.
#pragma once

#include <array>
#include <atomic>
#include <memory>
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

// All of a scene.
class ObjectSources {
 public:
  static constexpr std::uint32_t kMost = 1 << 16;

  // The number of a new entry, or kMost where all are used.
  std::uint32_t add(ObjectSource source);
  std::uint32_t count() const { return count_; }
  // index < count().
  const ObjectSource& operator[](std::uint32_t index) const {
    return *chunks_[index / kChunk]->at(index % kChunk);
  }

 private:
  static constexpr std::uint32_t kChunk = 256;
  using Chunk = std::array<std::unique_ptr<const ObjectSource>, kChunk>;
  std::array<std::unique_ptr<Chunk>, kMost / kChunk> chunks_;
  std::atomic<std::uint32_t> count_ = 0;  // written after the entry
};

// The type of copied meshes, or that of synthesised ones, which only modelers make.
std::unique_ptr<models::ModelType> make_object_type(std::shared_ptr<const ObjectSources> sources,
                                                    bool copied);

// The parameters that name a source.
models::Parameters object_parameters(std::uint32_t index);

}  // namespace psygen::scene
