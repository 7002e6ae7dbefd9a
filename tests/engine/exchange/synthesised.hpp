// A finished mesh of a standard model type as an object of a document.
#pragma once

#include <gtest/gtest.h>

#include "engine/exchange/unpack.hpp"
#include "engine/models/registry.hpp"
#include "engine/synthesis/synthesise.hpp"

namespace psygen::exchange {

inline const models::ModelType& standard_type(std::string_view name) {
  static const models::Registry registry = models::make_standard_registry();
  return registry[static_cast<models::ModelIndex>(registry.find(name))];
}

inline Object synthesised(const models::ModelType& type, const models::Parameters& p, int level) {
  const auto mesh = synthesis::HeapDestination::make(type, p, level);
  EXPECT_TRUE(mesh);
  EXPECT_TRUE(synthesis::synthesise_guarded(type, p, level, mesh->view()).ok);
  auto object = unpack(type, p, level, mesh->size(), mesh->view(), world::Palette{});
  EXPECT_TRUE(object) << object.error().message;
  return *object;
}

inline Object synthesised(std::string_view name, int level) {
  const models::ModelType& type = standard_type(name);
  return synthesised(type, models::default_parameters(type), level);
}

}  // namespace psygen::exchange
