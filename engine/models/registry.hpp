// The model types that a program knows, by name and by small index. Filled at start-up, then
// read-only and usable from any thread.
#pragma once

#include <algorithm>
#include <memory>
#include <string_view>
#include <vector>

#include "engine/models/model_type.hpp"

namespace psygen::models {

using ModelIndex = std::uint16_t;

class Registry {
 public:
  // Adds a type; refuses a second one of the same name and schemas that break their own rules
  // (more than Parameters::kMaxCount parameters, default outside its range, duplicate names).
  core::Result<ModelIndex> add(std::unique_ptr<ModelType> type);

  // Forgets the types added since there were so many; nobody may use them any more.
  void shrink(std::size_t size) { types_.resize(std::min(size, types_.size())); }

  std::size_t size() const { return types_.size(); }
  const ModelType& operator[](ModelIndex index) const { return *types_[index]; }
  // The index of a name, or -1.
  int find(std::string_view name) const;

 private:
  std::vector<std::unique_ptr<ModelType>> types_;
};

// Terrain, rock and tree (paper, section 5.2), and grass, in this order.
Registry make_standard_registry();

}  // namespace psygen::models
