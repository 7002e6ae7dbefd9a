// What an attached session does: figures, times of its systems, its entities and a map of its
// cache, and the commands that it takes. Main thread.
#pragma once

#include <QJsonObject>
#include <QWidget>
#include <functional>

#include "editor/attach/remote_session.hpp"

class QCheckBox;
class QLabel;
class QPushButton;

namespace psygen::editor {

class CacheMap;
class SystemBars;

class RemotePanel final : public QWidget {
  Q_OBJECT

 public:
  // Of a session that outlives the panel.
  explicit RemotePanel(RemoteSession& remote, QWidget* parent = nullptr);

 Q_SIGNALS:
  // The view shall show what the attached session's camera sees.
  void go_to(const psygen::core::CameraPose& pose);
  // Whether the attached session's camera shall follow the view's.
  void follow_me(bool on);

 private:
  void show_hello(const QJsonObject& hello);
  void show_figures(const QJsonObject& figures);
  void show_systems(const QJsonObject& systems);
  void show_entities(const QJsonObject& entities);
  void show_end(const QString& sentence);

  RemoteSession& remote_;
  QLabel *title_, *figures_, *kinds_;
  SystemBars* bars_;
  CacheMap* map_;
  QCheckBox *pause_, *follow_, *keep_;
  QPushButton *go_, *detach_;
};

}  // namespace psygen::editor
