#include "editor/shell/remote_commands.hpp"

#include <QDockWidget>

#include "editor/attach/attach_dialog.hpp"
#include "editor/attach/remote_panel.hpp"
#include "editor/attach/remote_session.hpp"
#include "editor/shell/file_commands.hpp"
#include "editor/shell/panel.hpp"
#include "engine/core/camera.hpp"

namespace psygen::editor {
namespace {

constexpr int kAttachedPx = 330;  // width of the panel while a program is attached

}  // namespace

RemoteCommands::RemoteCommands(const EditorContext& context, FileCommands& files)
    : QObject(&context.window),
      context_(context),
      files_(files),
      remote_(new RemoteSession(&context.window)),
      panel_(new RemotePanel(*remote_)) {
  connect(panel_, &RemotePanel::go_to_requested, &context_.model, &ModelView::go_to_world);
  connect(panel_, &RemotePanel::sync_camera_requested, this, [this](bool on) {
    follows_ = on && remote_->is_attached();
    if (!on && remote_->is_attached()) remote_->set_pose(std::nullopt);
  });
  connect(remote_, &RemoteSession::attached, this,
          [this](const QJsonObject&, const std::string& text) { on_attached(text); });
  connect(remote_, &RemoteSession::message_posted, this, [this](const QString& message) {
    context_.messages.show_message(tr("Attached program: %1").arg(message));
  });
  connect(remote_, &RemoteSession::ended, this, [this](const QString& reason) {
    follows_ = false;
    context_.messages.show_message(reason.isEmpty() ? tr("Detached.") : reason);
  });
  connect(&context_.document, &Document::changed, this, &RemoteCommands::send_world);
  connect(&context_.view, &WorldView::drawn, this, [this] {
    if (follows_) remote_->set_pose(context_.model.world_pose());
  });
}

void RemoteCommands::on_attached(const std::string& world_text) {
  show_panel(*panel_);
  context_.window.resizeDocks({&dock_of(context_.properties), &dock_of(*panel_)},
                              {kLeftPanelsPx, kAttachedPx}, Qt::Horizontal);
  if (world_text != context_.document.text()) {
    if (!files_.may_discard()) return remote_->detach(false);
    context_.messages.check(context_.document.make_new(world_text));
  }
  sent_world_ = context_.document.text();
  context_.messages.show_message(
      tr("Attached to process %1. It gets your changes at once.").arg(remote_->endpoint().pid));
}

void RemoteCommands::attach() {
  if (remote_->is_attached())
    return context_.messages.show_message(tr("Detach the attached program first, in its panel."));
  if (const auto endpoint = ask_endpoint(&context_.window))
    context_.messages.check(remote_->attach(*endpoint));
}

void RemoteCommands::send_world() {
  if (!remote_->is_attached() || context_.document.text() == sent_world_) return;
  sent_world_ = context_.document.text();
  remote_->set_world(sent_world_);
}

}  // namespace psygen::editor
