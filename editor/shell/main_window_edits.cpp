// Edits of the window: what the panels want is given to the document, what the document has become
// is given to panels and view, and costs are asked for.
#include <QApplication>
#include <QClipboard>
#include <QMenu>
#include <chrono>
#include <random>

#include "editor/cost/cost_worker.hpp"
#include "editor/cost/edit_cost.hpp"
#include "editor/gallery/model_view.hpp"
#include "editor/panels/cache_contents.hpp"
#include "editor/panels/field_row.hpp"
#include "editor/panels/impact_bar.hpp"
#include "editor/panels/properties_panel.hpp"
#include "editor/panels/statistics_panel.hpp"
#include "editor/shell/main_window.hpp"
#include "engine/scene/scene.hpp"
#include "engine/synthesis/mesh_supply.hpp"

namespace psygen::editor {
namespace {

constexpr int kCostsMs = 300;     // after the last change
constexpr int kLearntMs = 1'000;  // what is known of the scene may be so old
// Costs give way to what the view makes of a change, for so long.
constexpr std::chrono::milliseconds kMaxRest{2'000};
constexpr int kMaxPutOff = 10;  // times, for kCostsMs each

}  // namespace

void MainWindow::connect_document() {
  connect(&document_, &Document::changed, this, &MainWindow::document_changed);
  connect(&document_, &Document::modified_changed, this, &MainWindow::fit_title);
  connect(&document_, &Document::file_changed, this, &MainWindow::note_file);
  connect(&document_, &Document::disk_changed, this, &MainWindow::disk_changed);
  connect(&document_, &Document::autosave_failed, this, &MainWindow::say);
  document_.set_guard([this](const ParsedWorld& before, const ParsedWorld& after) {
    look_at_scene();
    CostLimits limits = options_.limits;
    limits.cache_bytes =
        std::min(limits.cache_bytes, static_cast<double>(options_.session.scene.budget_bytes));
    const EditCost cost = edit_cost(after, learnt_.get());
    if (cost_question({}, cost, limits).isEmpty()) return QString();  // as nearly always
    return cost_question(edit_cost(before, learnt_.get()), cost, limits);
  });
  ImpactBar& impact = properties_->impact();
  connect(&document_, &Document::asked, &impact, &ImpactBar::ask);
  connect(&impact, &ImpactBar::apply_wanted, this, [this] { tell(document_.apply_asked()); });
  connect(&impact, &ImpactBar::keep_wanted, this, [this] {
    document_.drop_asked();
    properties_->show(document_.sections());
  });
  connect_costs();
}

void MainWindow::connect_properties() {
  connect(properties_, &PropertiesPanel::wanted, this,
          [this](const world::TextPath& path, const std::string& toml) {
            if (tell(document_.set_value(path, toml))) return;
            properties_->show(document_.sections());  // back to what is
          });
  connect(properties_, &PropertiesPanel::reset_wanted, this,
          [this](const world::TextPath& path) { tell(document_.reset_value(path)); });
  connect(
      properties_, &PropertiesPanel::step_wanted, this,
      [this](const world::TextPath& path, int steps) { tell(document_.step_value(path, steps)); });
  connect(properties_, &PropertiesPanel::dice_wanted, this, &MainWindow::randomise);
  connect(properties_, &PropertiesPanel::copy_wanted, this, &MainWindow::copy_section);
  connect(properties_, &PropertiesPanel::paste_wanted, this, &MainWindow::paste_section);
  connect(properties_, &PropertiesPanel::section_reset_wanted, this,
          [this](const world::TextPath& path) { tell(document_.reset_section(path)); });
  connect(properties_, &PropertiesPanel::drag_began, this, [this] { set_dragging(true); });
  connect(properties_, &PropertiesPanel::drag_ended, this, [this] { set_dragging(false); });
  connect(properties_, &PropertiesPanel::row_made, this, [this](FieldRow* row) {
    row->set_locked(document_.locks().is_locked(row->field().path));
  });
  connect(properties_, &PropertiesPanel::lock_wanted, this,
          [this](const world::TextPath& path, bool locked) {
            document_.locks().set_locked(path, locked);
          });
  connect(properties_, &PropertiesPanel::section_chosen, this, &MainWindow::ask_costs);
  connect(properties_, &PropertiesPanel::section_menu, this, &MainWindow::section_menu);
}

void MainWindow::connect_costs() {
  connect(costs_, &CostWorker::curve, this,
          [this](const std::string& path, const std::vector<CostPoint>& points) {
            const auto at = world::parse_text_path(path);
            FieldRow* row = at ? properties_->row(*at) : nullptr;
            if (row != nullptr) row->show_cost(points);
          });
  connect(costs_, &CostWorker::world_cost, this, [this](const BlockCost& cost) {
    const world::World& world = document_.world();
    statistics_->show_world_cost(
        cost, static_cast<double>(world.blocks_x) * static_cast<double>(world.blocks_z));
  });
  connect(costs_, &CostWorker::impact, this, [this](const WorldImpact& impact) {
    properties_->impact().show_impact(impact_text(impact));
  });
  costs_timer_.setSingleShot(true);
  connect(&costs_timer_, &QTimer::timeout, this, &MainWindow::ask_costs);
}

// A drag is one undo step, its pictures are coarse, and its impact is that on the world it began
// with.
void MainWindow::set_dragging(bool on) {
  view_->set_draft(on);
  if (on) {
    document_.begin_drag();
    drag_from_ = document_.parsed();
  } else {
    document_.end_drag();
    drag_from_ = nullptr;
  }
}

void MainWindow::document_changed(Changes what) {
  // The slider that was dragged may be gone.
  if (drag_from_ && what.testAnyFlags(Change::kTables | Change::kFile)) set_dragging(false);
  properties_->show(document_.sections());
  // The renderer takes pictures of the ground only when it is made.
  const auto& images = document_.world().palette.images;
  model_->show(what.testFlag(Change::kFile) || images != shown_images_);
  shown_images_ = images;
  costs_timer_.start(kCostsMs);
  costs_put_off_ = 0;
  const ParsedWorldPtr before = drag_from_ ? drag_from_ : last_parsed_;
  last_parsed_ = document_.parsed();
  if (what.testFlag(Change::kFile) || view_->session() == nullptr || !before) return;
  look_at_scene();
  costs_->rest(kMaxRest);
  costs_->ask_impact(before, last_parsed_, view_->camera().pose().position.block, contents_,
                     learnt_);
}

// What the scene's cache holds and its cost model knows; during a drag, as it was before.
void MainWindow::look_at_scene() {
  if (view_->session() == nullptr || (learnt_ && drag_from_) ||
      (looked_.isValid() && looked_.elapsed() < kLearntMs))
    return;
  const scene::Scene& scene = view_->session()->scene();
  learnt_ = std::make_shared<synthesis::CostModel>(scene.meshes().costs());
  contents_ = contents_of(scene);
  looked_.start();
}

// Of the fields that are shown, once the view has what it needs.
void MainWindow::ask_costs() {
  if (view_->session() != nullptr && view_->awaits_meshes() && costs_put_off_++ < kMaxPutOff)
    return costs_timer_.start(kCostsMs);
  costs_put_off_ = 0;
  look_at_scene();
  costs_->ask(document_.text(), document_.file().string(), properties_->shown_fields(),
              view_->camera().pose().position.block, learnt_,
              handmade::files_with(document_.file(), document_.pictures()));
}

// What is not locked of a section or field.
void MainWindow::randomise(const world::TextPath& path) {
  static std::mt19937_64 random{std::random_device{}()};
  tell(document_.randomise(path, random));
}

void MainWindow::copy_section(const world::TextPath& path) {
  const auto text = document_.copy(path);
  if (!text) return say(QString::fromStdString(text.error().message));
  QApplication::clipboard()->setText(QString::fromStdString(*text));
  say(tr("Copied %1 as text.").arg(QString::fromStdString(path.text())));
}

void MainWindow::paste_section(const world::TextPath& path) {
  tell(document_.paste(path, QApplication::clipboard()->text().toStdString()));
}

void MainWindow::section_menu(const world::TextPath& path, const QPoint& at) {
  QMenu menu;
  menu.addAction(tr("Randomise"), this, [&] { randomise(path); });
  menu.addAction(tr("Reset"), this, [&] { tell(document_.reset_section(path)); });
  menu.addAction(tr("Copy"), this, [&] { copy_section(path); });
  menu.addAction(tr("Paste"), this, [&] { paste_section(path); });
  if (!path.empty() && path.back().is_index) {
    menu.addSeparator();
    menu.addAction(tr("Duplicate"), this, [&] { tell(document_.duplicate_table(path)); });
    menu.addAction(tr("Remove"), this, [&] { tell(document_.remove_table(path)); });
  }
  menu.exec(at);
}

}  // namespace psygen::editor
