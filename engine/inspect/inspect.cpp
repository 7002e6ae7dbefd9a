#include "engine/inspect/inspect.hpp"

#include <fmt/format.h>

#include <memory>

#include "ecs/ecs.hpp"
#include "engine/app/session.hpp"
#include "engine/core/log.hpp"
#include "engine/inspect/line_server.hpp"
#include "engine/inspect/visit.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/systems.hpp"

namespace psygen::inspect {
namespace {

constexpr int kMaxRequestsAFrame = 16;

// The server with its connection, owned by a session's schedule.
struct Desk {
  std::unique_ptr<LineServer> server;
  Visit visit;

  bool is_left = false;  // the client is gone, but the visit has not ended

  void frame(app::Session& session) {
    if (is_left) is_left = !visit.end(session);
    if (is_left) return;
    if (!server->attached()) {
      if (!server->accept()) return;
      visit.begin([server = server.get()] { return !server->has_left(); });
    }
    visit.note_frame(session.scene());
    server->receive();
    if (const auto late = visit.deferred_reply(session)) server->send(*late);
    for (int i = 0; i < kMaxRequestsAFrame && !visit.over() && !visit.is_busy(); ++i) {
      const auto line = server->take_line();
      if (!line) break;
      if (const auto answer = visit.answer(session, *line)) server->send(*answer);
      if (visit.has_greeted()) server->trust();
    }
    server->transmit();
    if (visit.over() && !server->is_sending()) server->drop();
    if (!server->attached()) is_left = !visit.end(session);
  }
};

}  // namespace

app::Plugin plugin(InspectOptions options) {
  // The systems own the server: it ends with the scene, even if the plugin is still held.
  const auto seat = std::make_shared<std::weak_ptr<Desk>>();
  app::Plugin plugin;
  plugin.name = "inspect";
  plugin.add_systems = [seat, options](scene::Systems& systems) -> core::Result<void> {
    auto server = LineServer::open(options.folder);
    if (!server) return tl::unexpected(server.error());
    core::log_info(fmt::format("inspection socket: {}", (*server)->address().string()));
    const auto desk = std::make_shared<Desk>();
    desk->server = std::move(*server);
    *seat = desk;
    systems.frame.add(
        "inspect",
        [desk](scene::Input& input) {
          if (const auto& pose = desk->visit.pose()) input.pose = *pose;
        },
        ecs::before("input"));
    return {};
  };
  plugin.on_frame = [seat](app::Session& session, double) {
    if (const auto desk = seat->lock()) desk->frame(session);
  };
  return plugin;
}

}  // namespace psygen::inspect
