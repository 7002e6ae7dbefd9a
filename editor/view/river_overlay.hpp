// The river network of the view's world as lines over the view. Another thread makes the map of the
// place around the camera (river_map.hpp); the lines of the previous map stay until then, so no
// frame waits. Off at first. Main thread.
#pragma once

#include <atomic>
#include <future>
#include <memory>
#include <vector>

#include "editor/view/river_map.hpp"
#include "engine/render/types.hpp"
#include "engine/world/world.hpp"

namespace psygen::editor {

// Appends the lines of a map's shores and then of its channels relative to a camera, each the far
// squares last, but not those farther than three halves of the finest square. Stops after
// kMaxRiverLines, which leave room for the grid and the tools. `pixel`: the size of a pixel over
// its distance.
inline constexpr std::size_t kMaxRiverLines = 48'000;
void add_river_lines(const RiverMap& map, const core::WorldPosition& eye, double block_m,
                     double pixel, std::vector<render::Line>& lines);

// One per view.
class RiverOverlay {
 public:
  RiverOverlay() = default;
  RiverOverlay(const RiverOverlay&) = delete;
  RiverOverlay& operator=(const RiverOverlay&) = delete;
  ~RiverOverlay();

  void set_on(bool on) { on_ = on; }
  bool is_on() const { return on_; }
  // Follows world and camera. Starts another map if the network or the world's size has changed, or
  // the camera has moved by a quarter of the finest square since the last map. Cancels a map in
  // work that is needed no longer. Takes microseconds.
  void follow(const world::World& world, const core::WorldPosition& eye);
  // The newest map; null: off, no network, or not ready yet.
  const std::shared_ptr<const RiverMap>& map() const { return map_; }
  // True while another thread makes a map.
  bool is_busy() const { return next_.valid(); }

 private:
  // The network and the size of the world of a map.
  struct Source {
    std::uint64_t network = 0;  // its identity
    std::int64_t blocks_x = 0, blocks_z = 0;
    friend bool operator==(const Source&, const Source&) = default;
  };
  // A map's source and place.
  struct Order {
    Source source;
    core::WorldPosition around;
  };
  void take();
  void start(const models::RiverNetwork& network, const Order& order);

  bool on_ = false;
  std::shared_ptr<const RiverMap> map_;
  Order of_map_, of_next_;
  std::shared_ptr<const models::RiverNetwork> network_;  // with a store that the world does not use
  std::future<std::shared_ptr<const RiverMap>> next_;
  std::shared_ptr<std::atomic<bool>> cancelled_;
};

}  // namespace psygen::editor
