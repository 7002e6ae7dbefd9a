// The connection to a session of another process (docs/inspect.md): polls its statistics and sends
// it worlds, only the newest one. Draws nothing. Main thread; never blocks.
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

// At most one connection at a time.
class RemoteSession final : public QObject {
  Q_OBJECT

 public:
  // Without a connection at first.
  explicit RemoteSession(QObject* parent = nullptr);
  ~RemoteSession() override;

  // Connects; attached() or ended() follow. Fails like inspect::Client::attach().
  core::Result<void> attach(const inspect::Endpoint& endpoint);
  // Disconnects. Restores the session's original state unless the changes are kept.
  void detach(bool keep);
  bool is_attached() const { return client_ != nullptr; }
  const inspect::Endpoint& endpoint() const { return endpoint_; }

  void set_world(const std::string& text);
  void set_paused(bool paused);
  // Overrides the pose of the session's camera; nullopt returns the camera to the program.
  void set_pose(const std::optional<core::CameraPose>& pose);
  // The last known pose of the session's camera.
  const std::optional<core::CameraPose>& pose() const { return pose_; }

 Q_SIGNALS:
  // The session has answered: its description, and the text of its world.
  void attached(const QJsonObject& hello, const std::string& world_text);
  // Answers to polls.
  void statistics(const QJsonObject& statistics);
  void systems(const QJsonObject& systems);
  void entities(const QJsonObject& entities);
  // The session rejected a request.
  void message_posted(const QString& message);
  // The session shows the last world that was sent.
  void world_applied();
  // The connection ended. The reason is empty after detach().
  void ended(const QString& reason);

 private:
  void send(const QString& command, QJsonObject request = {});
  void poll();
  void take(const QJsonObject& answer);
  void send_world();
  void end(const QString& reason);

  std::unique_ptr<inspect::Client> client_;
  inspect::Endpoint endpoint_;
  QTimer timer_;
  QStringList unanswered_;  // commands without an answer, in order
  QJsonObject hello_;
  bool greeted_ = false, world_is_sent_ = false;
  std::optional<std::string> next_world_;
  std::optional<core::CameraPose> pose_;
  int polls_ = 0;
  QString rejection_;
  QElapsedTimer detaching_;  // valid: since the command "detach"
};

// Converts a pose to the protocol's object, and back; nullopt for other objects.
QJsonObject pose_object(const core::CameraPose& pose);
std::optional<core::CameraPose> pose_of(const QJsonObject& object);

}  // namespace psygen::editor
