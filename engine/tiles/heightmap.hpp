// A region's ground as images for other programs: heights in metres (heights.exr, 32 bits) and
// scaled to 16 bits (heights.png), the visible fraction of each kind of ground (ground_grass.png
// and so on, 16 bits), and heightmap.json, which explains the numbers. In worlds with water also
// its depth in metres (water_depth.exr), its surface where it is wet (water_mask.png) and its flow
// in m/s along x and z (water_flow_x.exr, water_flow_z.exr). A pixel is a vertex of the ground at
// full detail; the first row is the northern border. Without models.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <utility>

#include "engine/amplify/region.hpp"
#include "engine/world/world.hpp"

namespace psygen::tiles {

// The maximum number of pixels along a side.
inline constexpr std::uint64_t kMaxHeightmapSide = 16384;

// Options for writing.
struct HeightmapOptions {
  unsigned threads = 1;
  const std::atomic<bool>* stop = nullptr;  // true: stop after the blocks in progress
  // Heights of black and white in heights.png, in metres; default: the lowest and highest point.
  // Regions with equal ranges join without a step.
  std::optional<std::pair<double, double>> range_m = {};
};

struct HeightmapReport {
  std::uint32_t width = 0, height = 0;  // pixels
  double min_m = 0, max_m = 0;          // lowest and highest point
};

// Writes the images into `folder`, which is created; heightmap.json comes last. Needs 8 bytes of
// memory for each pixel, 2 for each kind of ground, and 12 for water. Fails with kInvalidArgument
// for regions with more than kMaxHeightmapSide pixels along a side or heights beyond the range,
// with kInterrupted, and like image::write_png().
core::Result<HeightmapReport> write_heightmap(const world::World& world,
                                              const amplify::Region& region,
                                              const std::filesystem::path& folder,
                                              const HeightmapOptions& options);

}  // namespace psygen::tiles
