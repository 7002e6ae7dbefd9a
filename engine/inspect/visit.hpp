// One connection of an inspecting program: answers its requests, and restores its changes when it
// leaves. Independent of sockets. Main thread.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/camera.hpp"
#include "engine/inspect/scene_answers.hpp"
#include "engine/inspect/world_change.hpp"

namespace psygen::app {
class Session;
}

namespace psygen::inspect {

class Visit {
 public:
  // Begins a new connection without changes. Requires that the previous one has ended.
  void begin() { *this = Visit(); }
  // The client is gone: restores the world, the pause and the camera, unless the client asked to
  // keep its changes or the game has changed them since. Another thread prepares the world, so call
  // this once a frame until it returns true.
  bool end(app::Session& session);
  // Gathers the statistics of a frame for replies. Call after every tick.
  void note_frame(const scene::Scene& scene) { frames_.note(scene); }

  // Returns the reply to a request, one line of JSON without its end. Every text gets a reply.
  // Returns nullopt if the reply comes later; no other request may be made until then.
  std::optional<std::string> answer(app::Session& session, std::string_view request);
  // Returns the deferred reply once it is ready. Call once a frame.
  std::optional<std::string> deferred_reply(app::Session& session);
  bool is_busy() const { return change_.is_under_way(); }
  bool has_greeted() const { return greeted_; }
  // The client announced that it leaves.
  bool over() const { return over_; }
  // Camera pose that overrides the game's.
  const std::optional<core::CameraPose>& pose() const { return pose_; }

 private:
  using Reply = core::Result<Json>;
  Reply reply(app::Session& session, const Json& request);
  Reply hello(app::Session& session, const Json& request);
  core::Result<void> set_world(app::Session& session, const Json& request);
  Reply pause(app::Session& session, const Json& request);
  Reply place(app::Session& session, const Json& request);
  Reply detach(const Json& request);

  bool greeted_ = false, over_ = false, keep_ = false;
  FrameNotes frames_;
  WorldChange change_;
  Json change_id_;                           // id of its request
  std::string before_change_;                // text of the world before the change
  bool is_ending_ = false;                   // the change restores the world
  std::optional<std::string> world_before_;  // original text of the world; nullopt: unchanged
  std::string world_set_;                    // the last world set, as written by write_world()
  std::optional<bool> paused_before_;
  bool paused_set_ = false;
  std::optional<core::CameraPose> pose_;
};

}  // namespace psygen::inspect
