// A handmade model as a model type: one shape, which instances scale and rotate. Any thread.
#pragma once

#include <memory>
#include <string>

#include "engine/handmade/shape.hpp"
#include "engine/models/model_type.hpp"

namespace psygen::handmade {

// `doc` is a one-line description for users.
std::unique_ptr<models::ModelType> make_handmade_type(std::string name, std::string doc,
                                                      std::shared_ptr<const Shape> shape);

}  // namespace psygen::handmade
