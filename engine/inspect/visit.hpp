// One connection of an inspecting program: answers its requests, and restores its changes when it
// leaves. Independent of sockets. Main thread.
#pragma once

#include <future>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/camera.hpp"
#include "engine/core/error.hpp"
#include "engine/inspect/scene_answers.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/scene.hpp"

namespace psygen::app {
class Session;
}

namespace psygen::app {
class Session;
}

namespace psygen::inspect {

// Screens a request before it is parsed as JSON: other texts could take any amount of memory and
// time. Returns true if a text has at most 64 brackets, commas and colons outside strings, nested
// at most 4 deep. Linear in the text.
bool is_small_json(std::string_view text);

// Replaces a session's world, prepared by another thread while the session continues. On a virtual
// clock the session waits for it, so that a flight stays reproducible.
class WorldChange {
 public:
  WorldChange() = default;
  // Waits for the thread, which uses the session.
  ~WorldChange() { wait(); }
  WorldChange(WorldChange&&) = default;
  WorldChange& operator=(WorldChange&& other) noexcept;

  // Starts to prepare the world of a text. Requires that no change is under way.
  void start(app::Session& session, std::string text);
  bool is_under_way() const { return prepared_.valid(); }
  // Shows the world once it is prepared and returns the result of Session::set_world(). Returns
  // nullopt before that, and without a change.
  std::optional<core::Result<void>> finish(app::Session& session);
  // Discards the world once it is prepared, without showing it. Returns true if no change is left.
  bool drop();

 private:
  bool is_ready() const;
  void wait() const {
    if (prepared_.valid()) prepared_.wait();
  }

  std::future<core::Result<scene::PreparedWorld>> prepared_;
};

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
