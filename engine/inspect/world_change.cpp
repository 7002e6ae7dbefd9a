#include "engine/inspect/world_change.hpp"

#include <chrono>
#include <memory>
#include <utility>

#include "engine/app/session.hpp"
#include "engine/core/start_thread.hpp"
#include "engine/scene/settings.hpp"

namespace psygen::inspect {

WorldChange& WorldChange::operator=(WorldChange&& other) noexcept {
  wait();
  prepared_ = std::move(other.prepared_);
  return *this;
}

void WorldChange::start(app::Session& session, std::string text) {
  using Task = std::packaged_task<core::Result<scene::PreparedWorld>()>;
  const auto task = std::make_shared<Task>(session.prepare_world(std::move(text)));
  prepared_ = task->get_future();
  auto thread = core::start_thread([task] { (*task)(); });
  if (!thread) return (*task)();
  thread->detach();
  if (session.scene().settings().virtual_time) wait();
}

bool WorldChange::is_ready() const {
  return prepared_.valid() &&
         prepared_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

std::optional<core::Result<void>> WorldChange::finish(app::Session& session) {
  if (!is_ready()) return std::nullopt;
  auto prepared = prepared_.get();
  if (!prepared) return tl::make_unexpected(std::move(prepared.error()));
  return session.show_world(std::move(*prepared));
}

bool WorldChange::drop() {
  if (is_ready()) prepared_ = {};
  return !is_under_way();
}

}  // namespace psygen::inspect
