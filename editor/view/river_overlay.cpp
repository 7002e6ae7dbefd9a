#include "editor/view/river_overlay.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "engine/core/task.hpp"
#include "engine/models/network/store.hpp"

namespace psygen::editor {
namespace {

constexpr std::size_t kStoreBytes = std::size_t{16} << 20;
// Height of lines above the water. They are also nearer to the camera, at the same pixels, because
// the renderer draws far water by 2 % nearer (shaders/water_surface.vert).
constexpr float kLiftM = 0.15F, kLiftPerM = 0.002F, kNearer = 0.03F, kNearerFromM = 40,
                kNearerFullyM = 250;
// Lines end at this distance, in halves of the finest square, and are thin from a third of it on:
// farther ones would cover the horizon.
constexpr double kSeenHalves = 3;

}  // namespace

RiverOverlay::~RiverOverlay() {
  if (!next_.valid()) return;
  *cancelled_ = true;
  next_.wait();
}

void RiverOverlay::follow(const world::World& world, const core::WorldPosition& eye) {
  const models::RiverNetwork* const network = on_ ? world.network() : nullptr;
  const Source source{network == nullptr ? 0 : network->identity(), world.blocks_x, world.blocks_z};
  if (next_.valid() && (network == nullptr || of_next_.source != source)) *cancelled_ = true;
  take();
  if (network == nullptr) {
    map_ = nullptr;
    return;
  }
  if (next_.valid()) return;
  if (map_ != nullptr && of_map_.source == source) {
    const core::WorldPosition& around = of_map_.around;
    const glm::dvec3 away = core::offset_m(around.block, eye, world.block_size_m()) + around.local;
    if (std::max(std::abs(away.x), std::abs(away.z)) < 0.5 * map_->near_m) return;
  }
  start(*network, {source, eye});
}

void RiverOverlay::take() {
  if (!core::is_ready(next_)) return;
  auto made = next_.get();
  if (*cancelled_) return;  // a part of a map, or an obsolete one
  map_ = std::move(made);
  of_map_ = of_next_;
}

void RiverOverlay::start(const models::RiverNetwork& network, const Order& order) {
  of_next_ = order;
  if (network_ == nullptr || network_->identity() != network.identity()) {
    auto own = models::RiverNetwork::create(network.settings(), network.frame(),
                                            std::make_shared<models::NetworkStore>(kStoreBytes));
    if (!own) return;  // the world's one has the same settings
    network_ = std::move(*own);
  }
  cancelled_ = std::make_shared<std::atomic<bool>>(false);
  next_ = core::start_task(
      [own = network_, order, cancelled = cancelled_] {
        const glm::dvec2 blocks(static_cast<double>(order.source.blocks_x),
                                static_cast<double>(order.source.blocks_z));
        return std::make_shared<const RiverMap>(
            make_river_map(*own, order.around, blocks, *cancelled));
      },
      core::TaskPriority::kLowest);
}

void add_river_lines(const RiverMap& map, const core::WorldPosition& eye, double block_m,
                     double pixel, std::vector<render::Line>& lines) {
  const std::size_t end = lines.size() + kMaxRiverLines;
  const glm::vec3 from_eye(core::offset_m(map.corner, eye, block_m));
  const auto seen_m = static_cast<float>(kSeenHalves * map.near_m);
  const auto lifted = [](glm::vec3 at) {
    const float away_m = glm::length(at);
    at.y += kLiftM + kLiftPerM * away_m;
    return at * (1 - kNearer * glm::smoothstep(kNearerFromM, kNearerFullyM, away_m));
  };
  // False: the limit of lines is reached.
  const auto add = [&](const RiverMap::Line& line, const glm::vec3& colour, int width_px) {
    const float away_m = glm::length(0.5F * (line.from + line.to) + from_eye);
    if (away_m > seen_m) return true;
    if (3 * away_m > seen_m) width_px = std::min(width_px, 2);
    const glm::vec3 from = lifted(line.from + from_eye), to = lifted(line.to + from_eye);
    // Parallel lines a pixel apart are a wide one.
    const glm::vec3 middle = 0.5F * (from + to), across = glm::cross(to - from, middle);
    const float length = glm::length(across);
    const glm::vec3 step = length > 0
                               ? across * (glm::length(middle) * static_cast<float>(pixel) / length)
                               : glm::vec3(0.0F);
    for (int k = 0; k < width_px; ++k) {
      if (lines.size() == end) return false;
      const glm::vec3 aside =
          step * (static_cast<float>(k) - 0.5F * static_cast<float>(width_px - 1));
      lines.push_back({from + aside, to + aside, colour});
    }
    return true;
  };
  for (const RiverMap::Line& shore : map.shores)
    if (!add(shore, kShoreColour, 1)) return;
  for (const RiverMap::Channel& channel : map.channels)
    if (!add(channel.line, river_colour(channel.width_px), channel.width_px)) return;
}

}  // namespace psygen::editor
