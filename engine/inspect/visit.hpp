// One visit of a program that inspects a session: answers its requests, and when it leaves puts
// back what it changed. Knows no sockets. Main thread.
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
  // A new visitor: nothing is changed yet. Not before the one before has ended.
  void begin() { *this = Visit(); }
  // The visitor is gone: the world, the pause and the camera are again what they were, unless it
  // asked to keep its changes, or the game has changed them since. Call it once a frame until it
  // has ended, which it says: another thread prepares the world.
  bool end(app::Session& session);
  // Gathers what answers tell of frames since the last one. After every tick.
  void note_frame(const scene::State& state) { frames_.note(state); }

  // The answer to a request, one line of JSON without its end. Any text is answered; nothing: the
  // answer comes late, and no other request may be made until then.
  std::optional<std::string> answer(app::Session& session, std::string_view request);
  // That answer, once it is there. Once a frame.
  std::optional<std::string> late_answer(app::Session& session);
  bool is_busy() const { return change_.is_under_way(); }
  bool has_greeted() const { return greeted_; }
  // It said that it leaves.
  bool over() const { return over_; }
  // Where the camera stands instead of where the game puts it.
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
  Json change_id_;                           // of its request
  std::string before_change_;                // the text of the world
  bool is_ending_ = false;                   // the change puts back the world
  std::optional<std::string> world_before_;  // the text; none: it was not changed
  std::string world_set_;                    // as write_world() writes what was set last
  std::optional<bool> paused_before_;
  bool paused_set_ = false;
  std::optional<core::CameraPose> pose_;
};

}  // namespace psygen::inspect
