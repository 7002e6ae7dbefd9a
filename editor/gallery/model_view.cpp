#include "editor/gallery/model_view.hpp"

#include <glm/geometric.hpp>
#include <utility>

#include "editor/document/qt_text.hpp"
#include "editor/panels/message_log.hpp"
#include "editor/pictures/model_world.hpp"
#include "engine/core/camera.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/scene/scene.hpp"
#include "engine/world/files/text_edit.hpp"
#include "engine/world/files/toml_values.hpp"

namespace psygen::editor {
namespace {

// A placement in front of the model of a portrait world. With `before`, the camera keeps its
// direction and distance.
std::optional<WorldView::CameraPlacement> placement_of(
    const scene::Scene& scene, const std::optional<WorldView::CameraPlacement>& before) {
  const scene::WorldFacts& facts = scene.facts();
  const auto model = isolated_model(facts.world, facts.registry);
  if (!model) return std::nullopt;
  // The typical part of its conservative bounds.
  const core::Bounds whole = facts.registry[model->model].bounds(model->parameters);
  const core::Bounds& part = facts.typical_bounds[model->model];
  const core::Bounds box{whole.centre() + part.min * whole.half_extent(),
                         whole.centre() + part.max * whole.half_extent()};
  const double block_m = facts.world.block_size_m();
  const PortraitPose front = framing_pose(model->base, box, block_m, scene.camera().projection);
  if (!before || !before->pivot) return WorldView::CameraPlacement{front.pose, front.middle};
  core::CameraPose pose = before->pose;
  const glm::dvec3 to =
      core::offset_m(before->pivot->block, pose.position, block_m) + before->pivot->local;
  pose.position = front.middle;
  pose.position.local -= glm::dvec3(core::forward_of(pose)) * glm::length(to);
  return WorldView::CameraPlacement{pose, front.middle};
}

}  // namespace

ModelView::ModelView(Document& document, WorldView& view, MessageLog& messages, QObject* parent)
    : QObject(parent), document_(document), view_(view), messages_(messages) {}

core::Result<std::string> ModelView::portrait() const {
  auto text = portrait_of(document_.text(), *subject_);
  if (text) text = world::with_value(*text, {"world", "seed"}, world::toml_seed(seed_));
  // The renderer loads images of the ground only when it is created.
  const auto& images = document_.world().palette.images;
  for (std::size_t i = 0; i < images.size() && text; ++i) {
    if (!images[i].empty())
      text = world::with_value(*text, {"palette", std::string(world::kPaletteImages[i])},
                               world::toml_string(images[i]));
  }
  return text;
}

void ModelView::show(bool new_session) {
  const std::string file = document_.file().empty() ? "new.toml" : document_.file().string();
  if (subject_ && !new_session) {
    if (auto text = portrait())
      return view_.show_world(*std::move(text), file, false, document_.pictures());
  }
  close();  // another file, or the model no longer exists
  view_.show_world(document_.text(), file, new_session, document_.pictures());
}

void ModelView::open(const world::TextPath& section) {
  const auto subject = subject_of(section);
  if (!subject) return messages_.show_message(tr("Choose a species or a scatter layer first."));
  if (subject_ == subject) return;
  const std::optional<world::TextPath> before = std::exchange(subject_, subject);
  if (const auto text = portrait(); !text) {
    subject_ = before;
    return messages_.show_message(to_qstring(text.error().message));
  }
  if (!world_pose_) world_pose_ = view_.camera().pose();
  view_.select(std::nullopt);
  view_.camera().set_turntable(true);
  show(false);
  frame_model(false);
  Q_EMIT switched();
}

void ModelView::follow(const world::TextPath& section) {
  if (is_on() && subject_of(section)) open(section);
}

void ModelView::close() {
  if (!std::exchange(subject_, std::nullopt)) return;
  view_.camera().set_turntable(false);
  view_.select(std::nullopt);
  show(false);
  view_.place_camera_on_load(
      [pose = *std::exchange(world_pose_, std::nullopt)](const scene::Scene&) {
        return WorldView::CameraPlacement{pose, std::nullopt};
      });
  Q_EMIT switched();
}

void ModelView::go_to_world(const core::CameraPose& pose) {
  if (!is_on()) return view_.camera().set_pose(pose);
  world_pose_ = pose;
  close();
}

void ModelView::set_seed(std::uint64_t seed) {
  if (std::exchange(seed_, seed) == seed || !is_on()) return;
  show(false);
  frame_model(true);
}

void ModelView::frame_model(bool keep_direction) {
  std::optional<WorldView::CameraPlacement> before;
  if (keep_direction) before = {view_.camera().pose(), view_.camera().pivot()};
  view_.place_camera_on_load(
      [before](const scene::Scene& scene) { return placement_of(scene, before); });
}

QString ModelView::title() const {
  if (!subject_) return {};
  for (const world::WorldSection& section : document_.sections()) {
    if (section.path == *subject_) return to_qstring(section.title);
  }
  return {};
}

}  // namespace psygen::editor
