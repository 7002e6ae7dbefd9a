// The model types of a program, by name and by small index. Filled at start-up by one thread, then
// read-only and usable from any thread. Knows no worlds and no meshes.
#pragma once

#include <memory>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "engine/models/model_type.hpp"

namespace psygen::models {

// Index of a type in its registry.
using ModelIndex = std::uint16_t;

// Owns its types. References to them stay valid while the registry lives, until shrink().
class Registry {
 public:
  // Adds a type and returns its index. Fails with kInvalidArgument for null, a name that is not
  // snake_case or already taken, a type without levels, and a broken schema. A schema is broken by
  // more than Parameters::kMaxCount parameters, a default outside its range or duplicate names.
  // Fails with kOverBudget when all indices are used.
  core::Result<ModelIndex> add(std::unique_ptr<ModelType> type);

  // Destroys the types from index `size` on. References to them become invalid.
  void shrink(std::size_t size);

  // Number of types, and the type of an index below it.
  std::size_t size() const { return types_.size(); }
  const ModelType& operator[](ModelIndex index) const { return *types_[index]; }
  // Returns the index of a name, or -1. O(1).
  int find(std::string_view name) const;

 private:
  std::vector<std::unique_ptr<ModelType>> types_;
  std::unordered_map<std::string_view, ModelIndex> by_name_;  // the types own the names
};

// Makes a registry of terrain, rock and tree (paper, section 5.2) and grass, in this order.
Registry make_standard_registry();

}  // namespace psygen::models
