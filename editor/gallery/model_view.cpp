#include "editor/gallery/model_view.hpp"

#include <glm/geometric.hpp>
#include <utility>

#include "editor/pictures/model_world.hpp"
#include "engine/core/camera.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/frame/camera.hpp"
#include "engine/scene/scene.hpp"
#include "engine/world/files/text_edit.hpp"
#include "engine/world/files/toml_values.hpp"

namespace psygen::editor {
namespace {

// The species or scatter that a path is in.
std::optional<world::TextPath> subject_of(const world::TextPath& path) {
  if (path.size() < 2 || !path.steps[1].is_index) return std::nullopt;
  const std::string& table = path.steps[0].key;
  if (table != "species" && table != "scatter") return std::nullopt;
  return path.first(2);
}

// In front of the model of a portrait world. With `before` the camera keeps its direction and
// distance.
std::optional<WorldView::Stand> stand_of(const scene::Scene& scene,
                                         const std::optional<WorldView::Stand>& before) {
  const scene::WorldFacts& facts = scene.facts();
  const auto model = lonely_model(facts.world, facts.registry);
  if (!model) return std::nullopt;
  // What its type usually fills of its box.
  const core::Bounds whole = facts.registry[model->model].bounds(model->parameters);
  const core::Bounds& part = facts.typical_bounds[model->model];
  const core::Bounds box{whole.centre() + part.min * whole.half_extent(),
                         whole.centre() + part.max * whole.half_extent()};
  const double block_m = facts.world.block_size_m();
  const PortraitPose front = pose_before(model->foot, box, block_m, scene.camera().projection);
  if (!before || !before->pivot) return WorldView::Stand{front.pose, front.middle};
  core::CameraPose pose = before->pose;
  const glm::dvec3 to =
      core::offset_m(before->pivot->block, pose.position, block_m) + before->pivot->local;
  pose.position = front.middle;
  pose.position.local -= glm::dvec3(core::forward_of(pose)) * glm::length(to);
  return WorldView::Stand{pose, front.middle};
}

}  // namespace

ModelView::ModelView(Document& document, WorldView& view, QObject* parent)
    : QObject(parent), document_(document), view_(view) {}

core::Result<std::string> ModelView::portrait() const {
  const std::size_t index = subject_->steps[1].index;
  auto text = subject_->steps[0].key == "species" ? species_portrait(document_.text(), index)
                                                  : scatter_portrait(document_.text(), index);
  if (text) text = world::with_value(*text, {"world", "seed"}, world::toml_seed(seed_));
  // The renderer takes pictures of the ground only when it is made.
  const auto& images = document_.world().palette.images;
  for (std::size_t i = 0; i < images.size() && text; ++i) {
    if (!images[i].empty())
      text = world::with_value(*text, {"palette", std::string(world::kPaletteImages[i])},
                               world::toml_string(images[i]));
  }
  return text;
}

void ModelView::show(bool anew) {
  const std::string file = document_.file().empty() ? "new.toml" : document_.file().string();
  if (subject_ && !anew) {
    if (auto text = portrait())
      return view_.show_world(*std::move(text), file, false, document_.pictures());
  }
  close();  // another file, or the model is gone
  view_.show_world(document_.text(), file, anew, document_.pictures());
}

void ModelView::open(const world::TextPath& section) {
  const auto subject = subject_of(section);
  if (!subject)
    return Q_EMIT told(tr("Choose a species or something scattered first: it is shown alone."));
  if (subject_ == subject) return;
  const std::optional<world::TextPath> before = std::exchange(subject_, subject);
  if (const auto text = portrait(); !text) {
    subject_ = before;
    return Q_EMIT told(QString::fromStdString(text.error().message));
  }
  if (!world_pose_) world_pose_ = view_.camera().pose();
  view_.select(std::nullopt);
  view_.camera().set_turntable(true);
  show(false);
  stand_before(false);
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
  view_.stand_with_text([pose = *std::exchange(world_pose_, std::nullopt)](const scene::Scene&) {
    return WorldView::Stand{pose, std::nullopt};
  });
  Q_EMIT switched();
}

void ModelView::stand_in_world(const core::CameraPose& pose) {
  if (!is_on()) return view_.camera().set_pose(pose);
  world_pose_ = pose;
  close();
}

void ModelView::set_seed(std::uint64_t seed) {
  if (std::exchange(seed_, seed) == seed || !is_on()) return;
  show(false);
  stand_before(true);
}

void ModelView::stand_before(bool keep_direction) {
  std::optional<WorldView::Stand> before;
  if (keep_direction) before = {view_.camera().pose(), view_.camera().pivot()};
  view_.stand_with_text([before](const scene::Scene& scene) { return stand_of(scene, before); });
}

core::CameraPose ModelView::world_pose() const {
  return world_pose_ ? *world_pose_ : view_.camera().pose();
}

QString ModelView::title() const {
  if (!subject_) return {};
  for (const world::WorldSection& section : document_.sections()) {
    if (section.path == *subject_) return QString::fromStdString(section.title);
  }
  return {};
}

}  // namespace psygen::editor
