#include "editor/attach/remote_session.hpp"

#include <QJsonArray>
#include <QJsonDocument>
#include <utility>

#include "editor/document/qt_text.hpp"
#include "engine/inspect/inspect.hpp"

namespace psygen::editor {
namespace {

constexpr int kPollMs = 30, kMaxDetachMs = 5000;
constexpr int kPollsPerStatistics = 8, kPollsPerMap = 16;

}  // namespace

QJsonObject pose_object(const core::CameraPose& pose) {
  const core::WorldPosition& at = pose.position;
  return {{"block", QJsonArray{at.block.x, at.block.z}},
          {"local_m", QJsonArray{at.local.x, at.local.y, at.local.z}},
          {"yaw", pose.yaw},
          {"pitch", pose.pitch}};
}

std::optional<core::CameraPose> pose_of(const QJsonObject& object) {
  const QJsonArray block = object["block"].toArray(), local = object["local_m"].toArray();
  if (block.size() != 2 || local.size() != 3) return std::nullopt;
  core::CameraPose pose;
  pose.position.block = {block[0].toInt(), block[1].toInt()};
  pose.position.local = {local[0].toDouble(), local[1].toDouble(), local[2].toDouble()};
  pose.yaw = object["yaw"].toDouble();
  pose.pitch = object["pitch"].toDouble();
  if (!core::is_valid(pose)) return std::nullopt;
  return pose;
}

RemoteSession::RemoteSession(QObject* parent) : QObject(parent) {
  connect(&timer_, &QTimer::timeout, this, &RemoteSession::poll);
}

RemoteSession::~RemoteSession() = default;

core::Result<void> RemoteSession::attach(const inspect::Endpoint& endpoint) {
  auto client = inspect::Client::attach(endpoint.socket);
  if (!client) return tl::unexpected(client.error());
  client_ = std::move(*client);
  endpoint_ = endpoint;
  unanswered_.clear();
  hello_ = {};
  greeted_ = world_is_sent_ = false;
  next_world_.reset();
  pose_.reset();
  polls_ = 0;
  rejection_.clear();
  detaching_.invalidate();
  send("hello", {{"protocol", inspect::kProtocol}});
  send("parameters");
  timer_.start(kPollMs);
  return {};
}

void RemoteSession::detach(bool keep) {
  if (!client_) return;
  if (detaching_.isValid()) return;
  if (!keep) return end({});
  // The connection stays open until the answer, so that nothing sent before is lost.
  if (next_world_) send_world();
  send("detach", {{"keep", true}});
  detaching_.start();
}

void RemoteSession::end(const QString& reason) {
  timer_.stop();
  client_.reset();
  detaching_.invalidate();
  Q_EMIT ended(reason);
}

void RemoteSession::send(const QString& command, QJsonObject request) {
  if (!client_) return;
  request["do"] = command;
  unanswered_.push_back(command);
  client_->ask(QJsonDocument(request).toJson(QJsonDocument::Compact).toStdString());
}

void RemoteSession::send_world() {
  world_is_sent_ = true;
  send("set_world", {{"text", to_qstring(*std::exchange(next_world_, std::nullopt))}});
}

void RemoteSession::set_world(const std::string& text) {
  if (!client_ || !greeted_) return;
  next_world_ = text;
  if (!world_is_sent_) send_world();
}

void RemoteSession::set_paused(bool paused) {
  send("pause", {{"on", paused}});
}

void RemoteSession::set_pose(const std::optional<core::CameraPose>& pose) {
  if (unanswered_.count("pose") > 1 && pose) return;  // a later pose replaces this one
  send("pose", {{"pose", pose ? QJsonValue(pose_object(*pose)) : QJsonValue()}});
}

void RemoteSession::poll() {
  while (client_) {
    const auto line = client_->take_answer();
    if (!line) break;
    take(QJsonDocument::fromJson(QByteArray::fromStdString(*line)).object());
  }
  if (!client_) return;
  if (!client_->is_open()) {
    if (detaching_.isValid()) return end({});
    return end(rejection_.isEmpty() ? tr("The attached program has ended.") : rejection_);
  }
  if (detaching_.isValid()) {
    if (detaching_.hasExpired(kMaxDetachMs))
      end(tr(
          "The program did not answer. It returns to its original state, without your changes."));
    return;
  }
  if (!greeted_) return;
  ++polls_;
  if (polls_ % kPollsPerStatistics == 0 && !unanswered_.contains("systems")) {
    send("figures");
    send("systems");
  }
  if (polls_ % kPollsPerMap == 0 && !unanswered_.contains("entities")) send("entities");
}

void RemoteSession::take(const QJsonObject& answer) {
  const QString command = unanswered_.isEmpty() ? QString() : unanswered_.takeFirst();
  const QString error = answer["error"].toString();
  if (command == "set_world") {
    world_is_sent_ = false;
    if (next_world_) {
      send_world();
    } else if (error.isEmpty()) {
      Q_EMIT world_applied();
    }
  }
  if (!answer["ok"].toBool()) {
    if (greeted_) {
      Q_EMIT message_posted(error);
    } else {
      rejection_ = error;
    }
    return;
  }
  if (command == "hello") hello_ = answer;
  if (command == "parameters" && !greeted_) {
    greeted_ = true;
    Q_EMIT attached(hello_, answer["text"].toString().toStdString());
  }
  if (command == "figures") {
    pose_ = pose_of(answer["camera"].toObject());
    Q_EMIT statistics(answer);
  }
  if (command == "systems") Q_EMIT systems(answer);
  if (command == "entities") Q_EMIT entities(answer);
}

}  // namespace psygen::editor
