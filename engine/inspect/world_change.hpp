// Replaces a session's world, prepared by another thread while the session continues. On a virtual
// clock the session waits for it, so that a flight stays reproducible. Main thread.
#pragma once

#include <future>
#include <optional>
#include <string>

#include "engine/core/error.hpp"
#include "engine/scene/facts/prepared_world.hpp"
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

}  // namespace psygen::inspect
