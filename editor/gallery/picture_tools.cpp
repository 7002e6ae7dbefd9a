#include "editor/gallery/picture_tools.hpp"

#include <QCoreApplication>
#include <QFileDialog>
#include <QLabel>
#include <QMainWindow>
#include <QMenu>
#include <QStatusBar>
#include <algorithm>

#include "editor/document/qt_text.hpp"
#include "editor/gallery/contact_sheet.hpp"
#include "editor/gallery/export_dialog.hpp"
#include "editor/gallery/library_panel.hpp"
#include "editor/panels/message_log.hpp"
#include "editor/pictures/picture_server.hpp"
#include "engine/core/camera.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/statistics.hpp"
#include "engine/synthesis/mesh_supply.hpp"
#include "engine/world/world.hpp"

namespace psygen::editor {
namespace {

constexpr std::uint32_t kLargeWidth = 3840;
constexpr double kMinEyeOverGroundM = 1;
constexpr int kFocusDelayMs = 400;  // ignores fields that the pointer only passes

}  // namespace

PictureTools::PictureTools(QMainWindow& window, Document& document, WorldView& view,
                           MessageLog& messages, const QString& device)
    : QObject(&window),
      window_(window),
      document_(document),
      view_(view),
      messages_(messages),
      service_(QCoreApplication::applicationFilePath(), device.isEmpty()
                                                            ? QStringList{kPicturesOption}
                                                            : QStringList{kPicturesOption, device}),
      library_(new LibraryPanel(document, service_, messages)),
      label_(new QLabel) {
  focus_delay_.setSingleShot(true);
  connect(&focus_delay_, &QTimer::timeout, this, [this] { focused_field_ = field_under_pointer_; });
  label_->setVisible(false);
  window_.statusBar()->addPermanentWidget(label_);
  service_.set_pictures([this] { return document_.pictures(); });
  connect(&view_, &WorldView::drawn, this, [this] {
    const scene::Scene& scene = view_.session()->scene();
    view_.set_background_work(BackgroundWork::kPictures, service_.waiting() > 0);
    service_.set_busy(scene.statistics().drawn.awaited > 0 || scene.meshes().outstanding() > 0);
  });
  connect(&document_, &Document::changed, this, [this](Change what) {
    // The view shows the document's text again.
    shows_marked_ = false;
    if (what == Change::kFile) {
      marked_.reset();
      if (compare_ != nullptr) compare_->hide();
    }
    // The new ground may be above the camera.
    if (what == Change::kGround && on_world_) {
      const core::WorldPosition& at = view_.camera().pose().position;
      if (at.local.y < world::surface_height_m(document_.world(), at) + kMinEyeOverGroundM)
        set_camera_height(kMinEyeOverGroundM);
    }
    update_label();
  });
}

void PictureTools::set_focused_field(const world::TextPath& field) {
  field_under_pointer_ = field;
  focus_delay_.start(kFocusDelayMs);
}

void PictureTools::set_on_world(bool on) {
  on_world_ = on;
  if (!on) shows_marked_ = false;
  update_label();
}

void PictureTools::set_camera_height(double above_m) {
  if (!on_world_) return;
  core::CameraPose pose = view_.camera().pose();
  pose.position.local.y = world::surface_height_m(document_.world(), pose.position) + above_m;
  view_.camera().set_pose(pose);
}

std::optional<ViewState> PictureTools::view_state() const {
  if (view_.session() == nullptr || !on_world_) return std::nullopt;
  const world::World& world = view_.session()->scene().world();
  const core::CameraPose& pose = view_.camera().pose();
  const core::WorldPosition& at = pose.position;
  const glm::dvec2 at_m = world.metres(at);
  const double surface_m = world::surface_height_m(world, at);
  ViewState state;
  state.place.at_m = {at_m.x, at.local.y, at_m.y};
  state.place.yaw = pose.yaw;
  state.place.pitch = pose.pitch;
  state.above_m = std::max(at.local.y - surface_m, 1.0);
  // Without a day the time has no effect; a running clock would make every image outdated.
  state.now_s = world.sky.day_length_s > 0 ? view_.session()->now_s() : 0;
  state.size = view_.session()->picture_size();
  return state;
}

// --- The contact sheet

void PictureTools::open_sheet() {
  if (sheet_ == nullptr) {
    sheet_ = new ContactSheet(
        document_, service_, messages_, [this] { return view_state(); }, &window_);
    connect(sheet_, &ContactSheet::value_applied, this, &PictureTools::set_camera_height);
  }
  if (!focused_field_.empty()) sheet_->suggest(focused_field_);
  sheet_->show();
  sheet_->raise();
  sheet_->activateWindow();
}

// --- Files

void PictureTools::add_to_file_menu(QMenu& menu) {
  menu.addAction(tr("&Export a model or block …"), tr("Ctrl+E"), this,
                 &PictureTools::export_selection);
  menu.addAction(tr("Save a &large image …"), tr("Shift+F12"), this,
                 &PictureTools::save_large_picture);
}

void PictureTools::export_selection() {
  const auto request =
      ask_export(&window_, document_, view_.selection(), view_.camera().pose().position.block);
  if (!request) return;
  const QString file = to_qstring(request->out);
  messages_.show_message(tr("Exporting %1 …").arg(file));
  service_.ask(*request, service_.new_batch(), 0, this, [this, file](const PictureReply& reply) {
    messages_.show_message(reply.error.empty()
                               ? tr("Exported %1: %2.").arg(file, to_qstring(reply.note))
                               : tr("Export failed: %1").arg(to_qstring(reply.error)));
  });
}

void PictureTools::save_large_picture() {
  const auto view = view_state();
  if (!view || view->size.width == 0) return messages_.show_message(tr("The view has no image."));
  const QString file = QFileDialog::getSaveFileName(&window_, tr("Save a large image as"),
                                                    "image.png", tr("Images (*.png)"));
  if (file.isEmpty()) return;
  PictureRequest request;
  request.text = document_.text();
  request.file = document_.file().string();
  request.out = file.toStdString();
  request.place = view->place;
  request.now_s = view->now_s;
  request.size = {kLargeWidth, kLargeWidth * view->size.height / view->size.width};
  messages_.show_message(tr("Rendering %1 …").arg(file));
  service_.ask(std::move(request), service_.new_batch(), 0, this,
               [this, file](const PictureReply& reply) {
                 messages_.show_message(reply.error.empty()
                                            ? tr("Saved %1.").arg(file)
                                            : tr("Saving failed: %1").arg(to_qstring(reply.error)));
               });
}

// --- A and B

void PictureTools::add_to_view_menu(QMenu& menu) {
  menu.addSeparator();
  menu.addAction(tr("&Mark this state as A"), tr("Shift+F8"), this, &PictureTools::mark);
  need_mark_ = {menu.addAction(tr("Swap &A and B"), tr("F8"), this, &PictureTools::swap),
                menu.addAction(tr("A and B &side by side"), tr("Ctrl+F8"), this,
                               [this] {
                                 if (compare_ == nullptr) {
                                   compare_ = new CompareWindow(
                                       service_, [this] { return view_state(); },
                                       [this] { return states(); }, &window_);
                                 }
                                 compare_->show();
                                 compare_->raise();
                               }),
                menu.addAction(tr("&Use A"), this, &PictureTools::use_marked)};
  update_label();
}

std::optional<std::pair<ComparedState, ComparedState>> PictureTools::states() const {
  if (!marked_) return std::nullopt;
  const std::string file = document_.file().string();
  return std::pair{ComparedState{*marked_, file, tr("A, %1").arg(marked_at_.toString("HH:mm"))},
                   ComparedState{document_.text(), file, tr("B, now")}};
}

void PictureTools::mark() {
  marked_ = document_.text();
  marked_pictures_ = document_.pictures();
  marked_at_ = QTime::currentTime();
  messages_.show_message(
      tr("Marked this state as A. Change the world, then press F8 to swap A and B."));
  update_label();
}

void PictureTools::swap() {
  if (!marked_) return;
  shows_marked_ = !shows_marked_;
  view_.show_world(shows_marked_ ? *marked_ : document_.text(),
                   document_.file().empty() ? "new.toml" : document_.file().string(), false,
                   shows_marked_ ? marked_pictures_ : document_.pictures());
  update_label();
}

void PictureTools::update_label() {
  for (QAction* action : need_mark_)
    action->setEnabled(marked_.has_value() && on_world_);
  label_->setVisible(marked_.has_value());
  if (!marked_) return;
  const QString colours =
      shows_marked_ ? "background: palette(highlight); color: palette(highlighted-text);" : "";
  label_->setStyleSheet(colours + " padding: 0 8px;");
  label_->setText(shows_marked_ ? tr("A, %1").arg(marked_at_.toString("HH:mm")) : tr("B, now"));
  label_->setToolTip(tr("F8 swaps A (the marked state) and B (the present state)."));
}

void PictureTools::use_marked() {
  if (!marked_) return;
  messages_.check(document_.set_text(*marked_, tr("Use A")));
}

}  // namespace psygen::editor
