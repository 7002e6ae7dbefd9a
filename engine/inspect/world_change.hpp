// Another world for a session, which a thread of its own prepares while the session goes on. On a
// virtual clock the session waits for it, so that a flight stays the same. Main thread.
#pragma once

#include <future>
#include <optional>
#include <string>

#include "engine/core/error.hpp"
#include "engine/scene/scene.hpp"

namespace psygen::app {
class Session;
}

namespace psygen::inspect {

class WorldChange {
 public:
  WorldChange() = default;
  // Waits for the thread, which uses the session.
  ~WorldChange() { wait(); }
  WorldChange(WorldChange&&) = default;
  WorldChange& operator=(WorldChange&& other) noexcept;

  // Begins to prepare the world of a text. Not while one is under way.
  void start(app::Session& session, std::string text);
  bool is_under_way() const { return prepared_.valid(); }
  // Once it is prepared: shows it, and says how that went (Session::set_world()). Nothing until
  // then, and without one.
  std::optional<core::Result<void>> finish(app::Session& session);
  // Lets go of it once it is prepared, and shows nothing. Whether there is none any more.
  bool drop();

 private:
  bool is_ready() const;
  void wait() const {
    if (prepared_.valid()) prepared_.wait();
  }

  std::future<core::Result<scene::PreparedWorld>> prepared_;
};

}  // namespace psygen::inspect
