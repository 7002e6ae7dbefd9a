#include "engine/inspect/visit.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <utility>

#include "engine/app/session.hpp"
#include "engine/core/log.hpp"
#include "engine/core/task.hpp"
#include "engine/inspect/inspect.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/settings.hpp"
#include "engine/world/files/world_file.hpp"
#include "engine/world/world.hpp"

namespace psygen::inspect {
namespace {

using core::invalid_argument;

std::string line_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string refusal(const Json& id, const std::string& sentence) {
  return line_of({{"id", id}, {"ok", false}, {"error", sentence}});
}

std::string reply_line(const Json& id, const Json& found) {
  Json whole = {{"id", id}, {"ok", true}};
  whole.update(found);
  return line_of(whole);
}

std::string written_world(const app::Session& session) {
  const scene::WorldFacts& facts = session.scene().facts();
  return world::write_world(facts.world, facts.registry);
}

constexpr int kMaxMarks = 64, kMaxDepth = 4;
constexpr std::size_t kMaxOutside = 4096;  // bytes outside strings: numbers, blanks
constexpr std::chrono::milliseconds kLookedAfter{10};

}  // namespace

std::optional<std::string> Visit::answer(app::Session& session, std::string_view request) {
  if (!is_small_json(request)) return refusal(nullptr, "a request must be one small JSON object");
  const Json json = Json::parse(request, nullptr, false);
  if (!json.is_object()) return refusal(nullptr, "a request must be one small JSON object");
  Json id = json.contains("id") ? json["id"] : Json();
  if (!id.is_number_integer()) id = nullptr;
  if (greeted_ && json.value("do", Json()) == "set_world") {
    change_id_ = id;
    if (auto begun = set_world(session, json); !begun) return refusal(id, begun.error().message);
    return deferred_reply(session);
  }
  Reply found = reply(session, json);
  return found ? reply_line(id, *found) : refusal(id, found.error().message);
}

Visit::Reply Visit::reply(app::Session& session, const Json& request) {
  const auto found = request.find("do");
  if (found == request.end() || !found->is_string())
    return invalid_argument("a request needs \"do\", a text");
  const auto& what = found->get_ref<const std::string&>();
  if (what == "hello") return hello(session, request);
  if (!greeted_) return invalid_argument("the first request must be hello");
  const scene::Scene& scene = session.scene();
  if (what == "figures") return figures(session, frames_);
  if (what == "systems") return systems(scene, frames_);
  if (what == "entities") return entities(scene);
  if (what == "parameters") return Json{{"text", world_text(session)}};
  if (what == "pause") return pause(session, request);
  if (what == "pose") return place(session, request);
  if (what == "detach") return detach(request);
  return invalid_argument(
      "the requests are hello, figures, systems, entities, parameters, set_world, pause, pose and "
      "detach");
}

Visit::Reply Visit::hello(app::Session& session, const Json& request) {
  const auto protocol = request.find("protocol");
  if (protocol == request.end() || *protocol != kProtocol)
    return invalid_argument(
        fmt::format("hello needs \"protocol\": \"{}\", the only supported one", kProtocol));
  greeted_ = true;
  const scene::Scene& scene = session.scene();
  return Json{{"protocol", kProtocol},
              {"pid", ::getpid()},
              {"world", scene.world().name},
              {"file", session.options().world_file.string()},
              {"device", session.renderer().device().name},
              {"block_m", scene.world().block_size_m()},
              {"headless", session.options().headless},
              {"virtual_clock", scene.settings().virtual_time}};
}

core::Result<void> Visit::set_world(app::Session& session, const Json& request) {
  const auto text = request.find("text");
  if (text == request.end() || !text->is_string())
    return invalid_argument("set_world needs \"text\", a text");
  before_change_ = world_before_ ? std::string() : world_text(session);
  change_.start(session, text->get<std::string>(), is_attached_);
  return {};
}

std::optional<std::string> Visit::deferred_reply(app::Session& session) {
  const auto done = change_.finish(session);
  if (!done) return std::nullopt;
  if (!*done) return refusal(change_id_, done->error().message);
  if (!world_before_) world_before_ = std::move(before_change_);
  world_set_ = written_world(session);
  return reply_line(change_id_, Json::object());
}

Visit::Reply Visit::pause(app::Session& session, const Json& request) {
  const auto on = request.find("on");
  if (on == request.end() || !on->is_boolean())
    return invalid_argument("pause needs \"on\", true or false");
  if (!paused_before_) paused_before_ = session.paused();
  paused_set_ = on->get<bool>();
  session.set_paused(paused_set_);
  return Json::object();
}

Visit::Reply Visit::place(app::Session& session, const Json& request) {
  const auto wanted = request.find("pose");
  if (wanted == request.end())
    return invalid_argument("pose needs \"pose\", an object, or null to release the camera");
  if (wanted->is_null()) {
    pose_.reset();
    return Json::object();
  }
  auto pose = pose_from(*wanted, session.scene().world().block_size_m());
  if (!pose) return tl::unexpected(pose.error());
  pose_ = *pose;
  return Json::object();
}

Visit::Reply Visit::detach(const Json& request) {
  keep_ = request.value("keep", Json(false)) == Json(true);
  over_ = true;
  return Json::object();
}

bool Visit::end(app::Session& session) {
  pose_.reset();
  if (!is_ending_) {
    if (!change_.drop()) return false;  // the last request is not shown any more
    is_ending_ = true;
    if (!keep_ && paused_before_ && session.paused() == paused_set_)
      session.set_paused(*paused_before_);
    if (!keep_ && world_before_ && written_world(session) == world_set_)
      change_.start(session, *world_before_, [] { return true; });
  }
  if (const auto done = change_.finish(session); done && !*done)
    core::log_warning(fmt::format("cannot restore the original world: {}", done->error().message));
  return !change_.is_under_way();
}

bool is_small_json(std::string_view text) {
  int depth = 0, marks = 0;
  std::size_t outside = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
      continue;
    }
    if (++outside > kMaxOutside) return false;
    if (c == '"') in_string = true;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (c == '[' || c == '{' || c == ',' || c == ':') ++marks;
    if (depth > kMaxDepth || marks > kMaxMarks) return false;
  }
  return true;
}

WorldChange& WorldChange::operator=(WorldChange&& other) noexcept {
  cancel();
  cancelled_ = std::move(other.cancelled_);
  prepared_ = std::move(other.prepared_);
  return *this;
}

void WorldChange::start(app::Session& session, std::string text, const IsWanted& is_wanted) {
  cancelled_ = std::make_shared<std::atomic<bool>>(false);
  prepared_ = core::start_task(session.prepare_world(std::move(text), cancelled_));
  if (!session.scene().settings().virtual_time) return;
  while (prepared_.wait_for(kLookedAfter) != std::future_status::ready) {
    if (session.stopped() || !is_wanted()) *cancelled_ = true;
  }
}

void WorldChange::cancel() {
  if (!prepared_.valid()) return;
  *cancelled_ = true;
  prepared_.wait();
}

bool WorldChange::is_ready() const {
  return core::is_ready(prepared_);
}

std::optional<core::Result<void>> WorldChange::finish(app::Session& session) {
  if (!is_ready()) return std::nullopt;
  auto prepared = prepared_.get();
  if (!prepared) return tl::make_unexpected(std::move(prepared.error()));
  return session.show_world(std::move(*prepared));
}

bool WorldChange::drop() {
  if (is_under_way()) *cancelled_ = true;
  if (is_ready()) prepared_ = {};
  return !is_under_way();
}

}  // namespace psygen::inspect
