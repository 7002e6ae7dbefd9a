#include "engine/tiles/heightmap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <new>
#include <vector>

#include "engine/core/headroom.hpp"
#include "engine/core/out_of_memory.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/image/image_io.hpp"
#include "engine/models/terrain/ground.hpp"
#include "engine/telemetry/output_file.hpp"
#include "engine/world/ground_blends.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/water.hpp"

namespace psygen::tiles {
namespace {

constexpr float kWhite = 65535.0F;

struct Pictures {
  image::FloatImage heights;
  std::array<image::GreyImage, world::kGroundKinds> kinds;
  image::FloatImage depths, flows_x, flows_z;  // of water; empty in a world without water

  Pictures(std::uint32_t width, std::uint32_t height, bool has_water) {
    const std::size_t pixels = std::size_t{width} * height;
    heights = {width, height, std::vector<float>(pixels)};
    for (image::GreyImage& kind : kinds)
      kind = {width, height, std::vector<std::uint16_t>(pixels)};
    if (!has_water) return;
    for (image::FloatImage* water : {&depths, &flows_x, &flows_z})
      *water = {width, height, std::vector<float>(pixels)};
  }
};

// Draws one block with all its vertices. Neighbours have equal values at their common border.
class Painter {
 public:
  Painter(const world::World& world, const amplify::Region& region, Pictures& pictures)
      : world_(world),
        region_(region),
        pictures_(pictures),
        palette_(world::drawn_palette(world)),
        side_(static_cast<std::uint32_t>(world.terrain.integer(models::kTerrainSize))) {}

  // Blocks at the eastern and southern border of the region have one more column and row.
  void paint(core::BlockCoord block) const {
    const models::BlockGround ground(world::terrain_parameters(world_, block), block,
                                     std::size_t{side_} * side_);
    const auto first_x = static_cast<std::uint32_t>(block.x - region_.x0) * (side_ - 1),
               first_z = static_cast<std::uint32_t>(block.z - region_.z0) * (side_ - 1);
    const std::uint32_t columns = block.x + 1 == region_.x1 ? side_ : side_ - 1,
                        rows = block.z + 1 == region_.z1 ? side_ : side_ - 1;
    for (std::uint32_t z = 0; z < rows; ++z)
      for (std::uint32_t x = 0; x < columns; ++x)
        paint_pixel(block, ground, {x, z},
                    std::size_t{first_z + z} * pictures_.heights.width + first_x + x);
  }

 private:
  void paint_pixel(core::BlockCoord block, const models::BlockGround& ground, glm::uvec2 vertex,
                   std::size_t pixel) const {
    const glm::dvec2 local = glm::dvec2(vertex) * world_.cell_m();
    const models::GroundPoint point = ground.at(local);
    const auto height_m = static_cast<float>(point.height_m);
    pictures_.heights.values[pixel] = height_m;
    const glm::vec2 place = world::pattern_place(block, world_.block_size_m(), glm::vec2(local));
    const world::GroundBlends blends =
        world::ground_blends(palette_, height_m, point.normal, place,
                             static_cast<float>(world::road_at(world_, block, local)));
    float seen = 1;  // fraction that later kinds leave uncovered
    for (std::size_t kind = blends.size(); kind-- > 0;) {
      pictures_.kinds[kind].grey[pixel] =
          static_cast<std::uint16_t>(seen * blends[kind] * kWhite + 0.5F);
      seen *= 1 - blends[kind];
    }
    if (pictures_.depths.values.empty()) return;
    const world::WaterPoint water =
        world::water_at(world_, {block, {local.x, 0, local.y}}, point.height_m);
    pictures_.depths.values[pixel] = static_cast<float>(water.depth_m);
    pictures_.flows_x.values[pixel] = water.flow_m_s.x;
    pictures_.flows_z.values[pixel] = water.flow_m_s.y;
  }

  const world::World& world_;
  const amplify::Region& region_;
  Pictures& pictures_;
  const world::Palette palette_;
  const std::uint32_t side_;
};

core::Result<void> paint_all(const Painter& painter, const amplify::Region& region,
                             unsigned threads, const std::atomic<bool>* stop) {
  std::atomic<std::uint64_t> next{0};
  std::atomic<bool> lacks_memory{false};
  const auto paint = [&](std::uint64_t i) {
    try {
      painter.paint(region.block(i));
    } catch (const std::bad_alloc&) {
      lacks_memory = true;
    }
  };
  const auto work = [&] {
    while (!lacks_memory && (stop == nullptr || !stop->load(std::memory_order_relaxed))) {
      const std::uint64_t i = next.fetch_add(1, std::memory_order_relaxed);
      if (i >= region.block_count()) return;
      paint(i);
    }
  };
  core::run_in_threads(threads, work);
  if (lacks_memory)
    return core::fail(core::ErrorCode::kOutOfMemory, core::out_of_memory("the ground of a block"));
  if (next.load() < region.block_count())
    return core::fail(core::ErrorCode::kInterrupted, "interrupted: no file was written");
  return {};
}

core::Result<void> write_pictures(const Pictures& pictures, const std::filesystem::path& folder,
                                  double black_m, double white_m) {
  const std::vector<float>& heights = pictures.heights.values;
  image::GreyImage spread{pictures.heights.width, pictures.heights.height, {}};
  const double range_m = std::max(white_m - black_m, 1e-6);
  spread.grey.reserve(heights.size());
  for (const float height : heights)
    spread.grey.push_back(static_cast<std::uint16_t>(
        (static_cast<double>(height) - black_m) / range_m * 65535 + 0.5));
  if (auto ok = image::write_exr(folder / "heights.exr", pictures.heights); !ok) return ok;
  if (auto ok = image::write_png(folder / "heights.png", spread); !ok) return ok;
  for (std::size_t kind = 0; kind < world::kGroundKinds; ++kind) {
    const auto file = folder / fmt::format("ground_{}.png", world::kGroundNames[kind]);
    if (auto ok = image::write_png(file, pictures.kinds[kind]); !ok) return ok;
  }
  if (pictures.depths.values.empty()) return {};
  image::GreyImage mask{pictures.depths.width, pictures.depths.height, {}};
  for (const float depth : pictures.depths.values)
    mask.grey.push_back(depth > 0 ? 65'535 : 0);
  if (auto ok = image::write_png(folder / "water_mask.png", mask); !ok) return ok;
  for (const auto& [name, picture] : {std::pair("water_depth.exr", &pictures.depths),
                                      std::pair("water_flow_x.exr", &pictures.flows_x),
                                      std::pair("water_flow_z.exr", &pictures.flows_z)}) {
    if (auto ok = image::write_exr(folder / name, *picture); !ok) return ok;
  }
  return {};
}

}  // namespace

core::Result<HeightmapReport> write_heightmap(const world::World& world,
                                              const amplify::Region& region,
                                              const std::filesystem::path& folder,
                                              const HeightmapOptions& options) {
  const auto cells = static_cast<std::uint64_t>(world.terrain.integer(models::kTerrainSize) - 1);
  const auto side = [&](std::int64_t blocks) {
    return static_cast<std::uint64_t>(blocks) * cells + 1;
  };
  const std::uint64_t width = side(region.x1 - region.x0), height = side(region.z1 - region.z0);
  if (width > kMaxHeightmapSide || height > kMaxHeightmapSide)
    return core::invalid_argument(
        fmt::format("a heightmap of {} x {} pixels is too large: at most {} per "
                    "side are allowed ({} blocks of this world)",
                    width, height, kMaxHeightmapSide, (kMaxHeightmapSide - 1) / cells));
  if (auto ok = telemetry::create_output_folder(folder); !ok) return tl::unexpected(ok.error());
  HeightmapReport report{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
  Pictures pictures(report.width, report.height, world::has_water(world));
  if (auto ok = paint_all(Painter(world, region, pictures), region, options.threads, options.stop);
      !ok)
    return tl::unexpected(ok.error());
  const auto [least, most] = std::ranges::minmax_element(pictures.heights.values);
  report.min_m = static_cast<double>(*least);
  report.max_m = static_cast<double>(*most);
  const auto [black_m, white_m] = options.range_m.value_or(std::pair{report.min_m, report.max_m});
  if (report.min_m < black_m || report.max_m > white_m)
    return core::invalid_argument(
        fmt::format("the heights of the region are {:.1f} to {:.1f} m, beyond the range {:g} to "
                    "{:g} m",
                    report.min_m, report.max_m, black_m, white_m));
  if (auto ok = write_pictures(pictures, folder, black_m, white_m); !ok)
    return tl::unexpected(ok.error());
  const std::string json = fmt::format(
      "{{\"width\":{},\"height\":{},\"cell_m\":{},\"height_of_black_m\":{},"
      "\"height_of_white_m\":{},\"west_m\":{},\"north_m\":{}}}\n",
      report.width, report.height, world.cell_m(), black_m, white_m,
      static_cast<double>(region.x0) * world.block_size_m(),
      static_cast<double>(region.z0) * world.block_size_m());
  if (auto ok = core::replace_file(folder / "heightmap.json", json); !ok)
    return tl::unexpected(ok.error());
  return report;
}

}  // namespace psygen::tiles
