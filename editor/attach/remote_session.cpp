#include "editor/attach/remote_session.hpp"

#include <QJsonArray>
#include <QJsonDocument>
#include <utility>

#include "engine/inspect/inspect.hpp"

namespace psygen::editor {
namespace {

constexpr int kPollMs = 30, kPollsAFigure = 8, kPollsAMap = 16, kLeavingMs = 5000;

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
  asked_.clear();
  hello_ = {};
  greeted_ = world_is_sent_ = false;
  next_world_.reset();
  pose_.reset();
  polls_ = 0;
  refusal_.clear();
  leaving_.invalidate();
  ask("hello", {{"protocol", inspect::kProtocol}});
  ask("parameters");
  timer_.start(kPollMs);
  return {};
}

void RemoteSession::detach(bool keep) {
  if (!client_) return;
  if (leaving_.isValid()) return;
  if (!keep) return end({});
  // The connection stays open until it is answered, so that nothing sent before is lost.
  if (next_world_) send_world();
  ask("detach", {{"keep", true}});
  leaving_.start();
}

void RemoteSession::end(const QString& sentence) {
  timer_.stop();
  client_.reset();
  leaving_.invalidate();
  Q_EMIT ended(sentence);
}

void RemoteSession::ask(const QString& what, QJsonObject request) {
  if (!client_) return;
  request["do"] = what;
  asked_.push_back(what);
  client_->ask(QJsonDocument(request).toJson(QJsonDocument::Compact).toStdString());
}

void RemoteSession::send_world() {
  world_is_sent_ = true;
  ask("set_world", {{"text", QString::fromStdString(*std::exchange(next_world_, std::nullopt))}});
}

void RemoteSession::set_world(const std::string& text) {
  if (!client_ || !greeted_) return;
  next_world_ = text;
  if (!world_is_sent_) send_world();
}

void RemoteSession::set_paused(bool paused) {
  ask("pause", {{"on", paused}});
}

void RemoteSession::set_pose(const std::optional<core::CameraPose>& pose) {
  if (asked_.count("pose") > 1 && pose) return;  // the next one will do
  ask("pose", {{"pose", pose ? QJsonValue(pose_object(*pose)) : QJsonValue()}});
}

void RemoteSession::poll() {
  while (client_) {
    const auto line = client_->take_answer();
    if (!line) break;
    take(QJsonDocument::fromJson(QByteArray::fromStdString(*line)).object());
  }
  if (!client_) return;
  if (!client_->is_open()) {
    if (leaving_.isValid()) return end({});
    return end(refusal_.isEmpty() ? tr("The program that was attached has ended.") : refusal_);
  }
  if (leaving_.isValid()) {
    if (leaving_.hasExpired(kLeavingMs)) end(tr("The program did not answer: it is as it was."));
    return;
  }
  if (!greeted_) return;
  ++polls_;
  if (polls_ % kPollsAFigure == 0 && !asked_.contains("systems")) {
    ask("figures");
    ask("systems");
  }
  if (polls_ % kPollsAMap == 0 && !asked_.contains("entities")) ask("entities");
}

void RemoteSession::take(const QJsonObject& answer) {
  const QString what = asked_.isEmpty() ? QString() : asked_.takeFirst();
  const QString error = answer["error"].toString();
  if (what == "set_world") {
    world_is_sent_ = false;
    if (next_world_) {
      send_world();
    } else if (error.isEmpty()) {
      Q_EMIT world_taken();
    }
  }
  if (!answer["ok"].toBool()) {
    if (greeted_) {
      Q_EMIT told(error);
    } else {
      refusal_ = error;
    }
    return;
  }
  if (what == "hello") hello_ = answer;
  if (what == "parameters" && !greeted_) {
    greeted_ = true;
    Q_EMIT attached(hello_, answer["text"].toString().toStdString());
  }
  if (what == "figures") {
    pose_ = pose_of(answer["camera"].toObject());
    Q_EMIT figures(answer);
  }
  if (what == "systems") Q_EMIT systems(answer);
  if (what == "entities") Q_EMIT entities(answer);
}

}  // namespace psygen::editor
