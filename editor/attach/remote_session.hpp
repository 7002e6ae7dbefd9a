// A session of another process that is inspected (docs/inspect.md): asks it again and again what it
// does, and sends it worlds, the newest only. Draws nothing. Main thread; never waits.
#pragma once

#include <QElapsedTimer>
#include <QJsonObject>
#include <QObject>
#include <QTimer>
#include <memory>
#include <optional>
#include <string>

#include "engine/core/camera.hpp"
#include "engine/core/error.hpp"
#include "engine/inspect/client.hpp"

namespace psygen::editor {

class RemoteSession final : public QObject {
  Q_OBJECT

 public:
  explicit RemoteSession(QObject* parent = nullptr);
  ~RemoteSession() override;

  // Connects; attached() or ended() follow. Fails like inspect::Client::attach().
  core::Result<void> attach(const inspect::Endpoint& endpoint);
  // Leaves. The session gets back what it was unless the changes are kept.
  void detach(bool keep);
  bool is_attached() const { return client_ != nullptr; }
  const inspect::Endpoint& endpoint() const { return endpoint_; }

  void set_world(const std::string& text);
  void set_paused(bool paused);
  // Where its camera stands from now on; nothing: where the game puts it.
  void set_pose(const std::optional<core::CameraPose>& pose);
  // Where its camera was last.
  const std::optional<core::CameraPose>& pose() const { return pose_; }

 Q_SIGNALS:
  // It has said what it is, and has this world.
  void attached(const QJsonObject& hello, const std::string& world_text);
  void figures(const QJsonObject& figures);
  void systems(const QJsonObject& systems);
  void entities(const QJsonObject& entities);
  // It refused a request, or took the last world that was sent (empty).
  void told(const QString& sentence);
  void world_taken();
  // It is no longer attached: an empty sentence if that was asked for.
  void ended(const QString& sentence);

 private:
  void ask(const QString& what, QJsonObject request = {});
  void poll();
  void take(const QJsonObject& answer);
  void send_world();
  void end(const QString& sentence);

  std::unique_ptr<inspect::Client> client_;
  inspect::Endpoint endpoint_;
  QTimer timer_;
  QStringList asked_;  // what is not answered yet, in order
  QJsonObject hello_;
  bool greeted_ = false, world_is_sent_ = false;
  std::optional<std::string> next_world_;
  std::optional<core::CameraPose> pose_;
  int polls_ = 0;
  QString refusal_;
  QElapsedTimer leaving_;  // valid: it was told that we leave
};

// A pose as the protocol writes it, and back; nothing where it is none.
QJsonObject pose_object(const core::CameraPose& pose);
std::optional<core::CameraPose> pose_of(const QJsonObject& object);

}  // namespace psygen::editor
