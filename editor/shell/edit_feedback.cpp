#include "editor/shell/edit_feedback.hpp"

#include <chrono>

#include "editor/cost/cost_worker.hpp"
#include "editor/panels/cache_contents.hpp"
#include "editor/panels/field_row.hpp"
#include "engine/scene/scene.hpp"
#include "engine/synthesis/mesh_supply.hpp"

namespace psygen::editor {
namespace {

constexpr int kDelayMs = 300;          // after the last change
constexpr int kMaxSceneAgeMs = 1'000;  // of the contents and the cost model read from the scene
// The view synthesises meshes of a change first; costs wait at most this long.
constexpr std::chrono::milliseconds kMaxRest{2'000};
constexpr int kMaxDelays = 10;  // of kDelayMs each

}  // namespace

EditFeedback::EditFeedback(const EditorContext& context, RegisterModels register_models,
                           CostLimits limits)
    : QObject(&context.window),
      context_(context),
      limits_(limits),
      worker_(new CostWorker(std::move(register_models), this)) {
  context_.document.set_guard([this](const ParsedWorld& before, const ParsedWorld& after) {
    return confirmation_for(before, after);
  });
  connect(&context_.document, &Document::changed, this, &EditFeedback::on_document_changed);
  connect(&context_.properties, &PropertiesPanel::section_chosen, this,
          &EditFeedback::request_costs);
  connect(worker_, &CostWorker::curve, this,
          [this](const world::TextPath& path, const std::vector<CostPoint>& points) {
            if (FieldRow* row = context_.properties.row(path)) row->show_cost(points);
          });
  connect(worker_, &CostWorker::world_cost, this, [this](const BlockCost& cost) {
    const world::World& world = context_.document.world();
    Q_EMIT block_cost_changed(
        cost, static_cast<double>(world.blocks_x) * static_cast<double>(world.blocks_z));
  });
  connect(worker_, &CostWorker::impact, this, [this](const WorldImpact& impact) {
    context_.properties.show_impact(impact_text(impact));
  });
  delay_.setSingleShot(true);
  connect(&delay_, &QTimer::timeout, this, &EditFeedback::request_costs);
  connect(&context_.view, &WorldView::opened, this, [this](const QString& error) {
    if (error.isEmpty()) request_costs();
  });
  connect(&context_.view, &WorldView::world_rejected, worker_, &CostWorker::resume);
  connect(&context_.view, &WorldView::answered, worker_, &CostWorker::resume);
}

// The question before an edit; empty for nearly all edits, which need no confirmation.
QString EditFeedback::confirmation_for(const ParsedWorld& before, const ParsedWorld& after) {
  read_scene();
  const EditCost cost = edit_cost(after, learnt_.get());
  if (editor::confirmation_for({}, cost, limits_).isEmpty()) return {};
  return editor::confirmation_for(edit_cost(before, learnt_.get()), cost, limits_);
}

void EditFeedback::set_dragging(bool on) {
  context_.view.set_draft(on);
  if (on) {
    context_.document.begin_drag();
    drag_start_ = context_.document.parsed();
  } else {
    context_.document.end_drag();
    drag_start_ = nullptr;
  }
}

void EditFeedback::on_document_changed(Change what) {
  if (drag_start_ && what == Change::kFile) set_dragging(false);
  context_.properties.show(context_.document.sections());
  // The renderer loads images of the ground only when it is created.
  const auto& images = context_.document.world().palette.images;
  context_.model.show(what == Change::kFile || images != shown_images_);
  shown_images_ = images;
  delay_.start(kDelayMs);
  delay_count_ = 0;
  const ParsedWorldPtr before = drag_start_ ? drag_start_ : last_parsed_;
  last_parsed_ = context_.document.parsed();
  if (what == Change::kFile || context_.view.session() == nullptr || !before) return;
  read_scene();
  worker_->rest(kMaxRest);
  worker_->request_impact({.before = before,
                           .after = last_parsed_,
                           .around = context_.view.camera().pose().position.block,
                           .contents = contents_,
                           .learnt = learnt_});
}

// Reads the cache contents and the cost model of the scene. During a drag they stay as they were.
void EditFeedback::read_scene() {
  if (context_.view.session() == nullptr || (learnt_ && drag_start_) ||
      (since_read_.isValid() && since_read_.elapsed() < kMaxSceneAgeMs))
    return;
  const scene::Scene& scene = context_.view.session()->scene();
  learnt_ = std::make_shared<synthesis::CostModel>(scene.meshes().costs());
  contents_ = contents_of(scene);
  since_read_.start();
}

// Requests the costs of the fields in the properties, once the view has its meshes.
void EditFeedback::request_costs() {
  if (context_.view.session() != nullptr && context_.view.awaits_meshes() &&
      delay_count_++ < kMaxDelays)
    return delay_.start(kDelayMs);
  delay_count_ = 0;
  read_scene();
  worker_->request_curves(
      {.text = context_.document.text(),
       .file = context_.document.file().string(),
       .fields = context_.properties.shown_fields(),
       .around = context_.view.camera().pose().position.block,
       .learnt = learnt_,
       .files = handmade::files_with(context_.document.file(), context_.document.pictures())});
}

}  // namespace psygen::editor
