#include "engine/inspect/visit.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "engine/app/session.hpp"
#include "engine/core/log.hpp"
#include "engine/inspect/inspect.hpp"
#include "engine/inspect/json_screen.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/settings.hpp"
#include "engine/world/files/world_file.hpp"
#include "engine/world/world.hpp"

namespace psygen::inspect {
namespace {

tl::unexpected<core::Error> refuse(std::string sentence) {
  return core::fail(core::ErrorCode::kInvalidArgument, std::move(sentence));
}

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
    return refuse("a request needs \"do\", a text");
  const auto& what = found->get_ref<const std::string&>();
  if (what == "hello") return hello(session, request);
  if (!greeted_) return refuse("the first request must be hello");
  const scene::Scene& scene = session.scene();
  if (what == "figures") return figures(session, frames_);
  if (what == "systems") return systems(scene, frames_);
  if (what == "entities") return entities(scene);
  if (what == "parameters") return Json{{"text", world_text(session)}};
  if (what == "pause") return pause(session, request);
  if (what == "pose") return place(session, request);
  if (what == "detach") return detach(request);
  return refuse(
      "the requests are hello, figures, systems, entities, parameters, set_world, pause, pose and "
      "detach");
}

Visit::Reply Visit::hello(app::Session& session, const Json& request) {
  const auto protocol = request.find("protocol");
  if (protocol == request.end() || *protocol != kProtocol)
    return refuse(
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
    return refuse("set_world needs \"text\", a text");
  before_change_ = world_before_ ? std::string() : world_text(session);
  change_.start(session, text->get<std::string>());
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
  if (on == request.end() || !on->is_boolean()) return refuse("pause needs \"on\", true or false");
  if (!paused_before_) paused_before_ = session.paused();
  paused_set_ = on->get<bool>();
  session.set_paused(paused_set_);
  return Json::object();
}

Visit::Reply Visit::place(app::Session& session, const Json& request) {
  const auto wanted = request.find("pose");
  if (wanted == request.end())
    return refuse("pose needs \"pose\", an object, or null to release the camera");
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
      change_.start(session, *world_before_);
  }
  if (const auto done = change_.finish(session); done && !*done)
    core::log_warning(fmt::format("cannot restore the original world: {}", done->error().message));
  return !change_.is_under_way();
}

}  // namespace psygen::inspect
