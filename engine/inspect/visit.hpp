// One connection of an inspecting program: answers its requests, and restores its changes when it
// leaves. Independent of sockets. Main thread.
#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "engine/core/camera.hpp"
#include "engine/core/error.hpp"
#include "engine/inspect/scene_answers.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/scene.hpp"

namespace psygen::app {
class Session;
}

namespace psygen::inspect {

// Screens a request before it is parsed as JSON: other texts could take any amount of memory and
// time. Returns true if a text has at most 64 brackets, commas and colons outside strings, nested
// at most 4 deep. Linear in the text.
bool is_small_json(std::string_view text);

// Replaces a session's world, prepared by another thread while the session continues. On a virtual
// clock the session waits for it, so that a flight stays reproducible. A change that nobody wants
// any more is cancelled, which takes some milliseconds.
class WorldChange {
 public:
  // False if the change is not wanted any more.
  using IsWanted = std::function<bool()>;

  WorldChange() = default;
  // Cancels the change and waits for its thread, which uses the session.
  ~WorldChange() { cancel(); }
  WorldChange(WorldChange&&) = default;
  WorldChange& operator=(WorldChange&& other) noexcept;

  // Starts to prepare the world of a text. Requires that no change is under way. While the session
  // waits for it, calls `is_wanted` every 10 ms.
  void start(app::Session& session, std::string text, const IsWanted& is_wanted);
  bool is_under_way() const { return prepared_.valid(); }
  // Shows the world once it is prepared and returns the result of Session::set_world(). Returns
  // nullopt before that, and without a change.
  std::optional<core::Result<void>> finish(app::Session& session);
  // Cancels the change, and discards the world once its thread has ended. Returns true if no change
  // is left.
  bool drop();

 private:
  bool is_ready() const;
  void cancel();

  std::shared_ptr<std::atomic<bool>> cancelled_;  // of the change under way
  std::future<core::Result<scene::PreparedWorld>> prepared_;
};

class Visit {
 public:
  // Begins a new connection without changes. Requires that the previous one has ended.
  // `is_attached` tells whether its client is still there.
  void begin(std::function<bool()> is_attached) {
    *this = Visit();
    is_attached_ = std::move(is_attached);
  }
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
  std::function<bool()> is_attached_ = [] { return true; };
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
