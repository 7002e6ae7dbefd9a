// The fixture of tests on every path that look at a model, an object and ground.
#pragma once

#include "tests/engine/render/on_a_path.hpp"

namespace psygen::render {

class OneOfEach : public OnAPath {
 protected:
  void SetUp() override {
    OnAPath::SetUp();
    if (!renderer_) return;
    const auto model = synthetic::make_box(renderer_->geometry(), glm::vec3(0.3F));
    const auto object = synthetic::make_object_box(renderer_->geometry(), glm::vec3(0.3F));
    const auto ground =
        synthetic::make_terrain(renderer_->geometry(), 64, [](int, int) { return 0.5F; });
    const auto grid = renderer_->upload_shared_indices(synthetic::grid_indices(64));
    ASSERT_TRUE(model && object && ground && grid);
    model_.range = *model;
    object_.range = *object;
    ground_.range = *ground;
    ground_.shared_indices = *grid;
    model_.origin = {-3, 0, -12};
    object_.origin = {3, 0, -12};
    ground_.origin = {-32, -3, -60};
    input_ = synthetic::look(60, 0, kSize);
    input_.models = {&model_, 1};
    input_.objects = {&object_, 1};
    input_.terrain = {&ground_, 1};
  }

  MeshDraw model_;
  ObjectDraw object_;
  TerrainDraw ground_;
  FrameInput input_;
};

}  // namespace psygen::render
