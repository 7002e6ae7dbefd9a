// The panel "Attached": statistics, system times, entities and cache map of an attached session,
// and its commands. Main thread.
#pragma once

#include <QJsonObject>
#include <QWidget>

#include "editor/attach/remote_session.hpp"

class QCheckBox;
class QLabel;
class QPushButton;

namespace psygen::editor {

class CacheMap;
class SystemBars;

// Shows the last answers of the session, and an empty panel without one.
class RemotePanel final : public QWidget {
  Q_OBJECT

 public:
  // The session outlives the panel.
  explicit RemotePanel(RemoteSession& remote, QWidget* parent = nullptr);

 Q_SIGNALS:
  // The user asks to move the view to the session's camera.
  void go_to_requested(const psygen::core::CameraPose& pose);
  // The user switches the sync of the session's camera to the view on or off.
  void sync_camera_requested(bool on);

 private:
  void show_hello(const QJsonObject& hello);
  void show_statistics(const QJsonObject& statistics);
  void show_systems(const QJsonObject& systems);
  void show_entities(const QJsonObject& entities);
  void show_end(const QString& sentence);

  RemoteSession& remote_;
  QLabel *title_, *statistics_, *kinds_;
  SystemBars* bars_;
  CacheMap* map_;
  QCheckBox *pause_, *follow_, *keep_;
  QPushButton *go_, *detach_;
};

}  // namespace psygen::editor
