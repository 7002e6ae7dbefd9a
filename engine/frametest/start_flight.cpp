#include "engine/frametest/start_flight.hpp"

namespace psygen::frametest {

core::Result<std::unique_ptr<app::Flight>> start_flight(app::FlightOptions flight,
                                                        const RunOptions& options,
                                                        const Hooks& hooks, app::Plugin last) {
  flight.session.device_name = options.device;
  flight.session.stop = options.stop;
  if (hooks.prepare) {
    if (auto ok = hooks.prepare(flight.session); !ok) return tl::unexpected(ok.error());
  }
  flight.camera = hooks.camera;
  if (!last.name.empty()) flight.session.plugins.push_back(std::move(last));
  auto made = app::Flight::create(std::move(flight));
  if (made && hooks.start) {
    if (auto ok = hooks.start((*made)->session()); !ok) return tl::unexpected(ok.error());
  }
  return made;
}

}  // namespace psygen::frametest
