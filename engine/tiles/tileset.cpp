#include "engine/tiles/tileset.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <mutex>
#include <numbers>
#include <optional>
#include <vector>

#include "engine/core/headroom.hpp"
#include "engine/core/out_of_memory.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/core/utf8.hpp"
#include "engine/exchange/write_document.hpp"
#include "engine/telemetry/output_file.hpp"
#include "engine/tiles/subtree.hpp"
#include "engine/tiles/tile_content.hpp"

namespace psygen::tiles {
namespace {

// Metres from the tileset's corner, y up.
struct Box {
  glm::dvec3 min{0.0}, max{0.0};
};

TileBox tile_box(const Box& box) {
  const glm::dvec3 centre = (box.min + box.max) * 0.5, half = (box.max - box.min) * 0.5;
  TileBox made{centre.x, -centre.z, centre.y};
  made[3] = half.x, made[7] = half.z, made[11] = half.y;
  return made;
}

// "transform" of the root, column by column: east, north and up at a place of WGS 84, as vectors
// from the Earth's centre, and the place itself.
std::string transform_json(const GeoPlace& place) {
  constexpr double kRadiusM = 6'378'137, kFlattening = 1 / 298.257223563;
  constexpr double kSquare = kFlattening * (2 - kFlattening);  // of the eccentricity
  const double latitude = place.latitude_deg * std::numbers::pi / 180;
  const double longitude = place.longitude_deg * std::numbers::pi / 180;
  const double s = std::sin(latitude), c = std::cos(latitude);
  const double t = std::sin(longitude), d = std::cos(longitude);
  const double normal_m = kRadiusM / std::sqrt(1 - kSquare * s * s);  // down to the Earth's axis
  const double away_m = (normal_m + place.height_m) * c;
  const std::array<double, 16> columns{
      -t,     d, 0,          0,          -s * d,
      -s * t, c, 0,          c * d,      c * t,
      s,      0, away_m * d, away_m * t, (normal_m * (1 - kSquare) + place.height_m) * s,
      1};
  return fmt::format(R"("transform":[{}],)", fmt::join(columns, ","));
}

// The existing tiles of a level: a rectangle.
struct Grid {
  Tile first;  // tile with the smallest x and y
  std::uint32_t columns = 0, rows = 0;
  std::vector<std::optional<Box>> boxes{};

  std::size_t count() const { return std::size_t{columns} * rows; }
  Tile tile(std::size_t i) const {
    return {first.level, first.x + static_cast<std::uint32_t>(i % columns),
            first.y + static_cast<std::uint32_t>(i / columns)};
  }
  std::optional<Box>& box(const Tile& t) {
    return boxes[std::size_t{t.y - first.y} * columns + (t.x - first.x)];
  }
};

Grid grid_of(const TileTree& tree, int level) {
  const amplify::Region& region = tree.region();
  const int k = tree.node_level({level, 0, 0});
  const auto tiles = [k](std::int64_t blocks) { return static_cast<std::uint32_t>(blocks >> k); };
  const std::uint32_t x0 = tiles(region.x0 - tree.corner().x),
                      x1 = tiles(region.x1 - 1 - tree.corner().x),
                      z0 = tiles(region.z0 - tree.corner().z),
                      z1 = tiles(region.z1 - 1 - tree.corner().z);
  const auto rows = static_cast<std::uint32_t>(std::uint64_t{1} << level);
  Grid grid{{level, x0, rows - 1 - z1}, x1 - x0 + 1, z1 - z0 + 1, {}};
  grid.boxes.resize(grid.count());
  return grid;
}

class Writer {
 public:
  Writer(const world::World& world, const models::Registry& registry, const TileTree& tree,
         const std::filesystem::path& folder, const TilesetOptions& options)
      : world_(world), tree_(tree), folder_(folder), options_(options), maker_(world, registry) {
    for (int level = 0; level < tree.level_count(); ++level) {
      grids_.push_back(grid_of(tree, level));
      if (tree.has_content(grids_.back().tile(0))) total_ += grids_.back().count();
    }
  }

  core::Result<TilesetReport> write() {
    if (auto ok = make_folders(); !ok) return tl::unexpected(ok.error());
    for (auto grid = grids_.rbegin(); grid != grids_.rend(); ++grid) {
      if (tree_.has_content(grid->tile(0)))
        if (auto ok = write_contents(*grid); !ok) return tl::unexpected(ok.error());
      enclose_children(*grid);
    }
    for (const Grid& grid : grids_)
      if (grid.first.level % kSubtreeLevels == 0)
        if (auto ok = write_subtrees(grid); !ok) return tl::unexpected(ok.error());
    if (auto ok = core::replace_file(folder_ / "tileset.json", tileset_json()); !ok)
      return tl::unexpected(ok.error());
    return report_;
  }

 private:
  std::filesystem::path file(const char* kind, const Tile& tile, const char* extension) const {
    return folder_ / kind / fmt::format("{}/{}/{}.{}", tile.level, tile.x, tile.y, extension);
  }

  core::Result<void> make_folders() const {
    if (auto ok = telemetry::create_output_folder(folder_); !ok) return ok;
    for (const Grid& grid : grids_) {
      for (std::uint32_t column = 0; column < grid.columns; ++column) {
        const Tile tile = grid.tile(column);
        for (const char* kind : {"content", "subtrees"}) {
          const bool needed =
              kind[0] == 'c' ? tree_.has_content(tile) : tile.level % kSubtreeLevels == 0;
          if (!needed) continue;
          const auto folder = file(kind, tile, "").parent_path();
          if (auto ok = telemetry::create_output_folder(folder); !ok) return ok;
        }
      }
    }
    return {};
  }

  core::Result<void> write_content(Grid& grid, std::size_t i) {
    const Tile tile = grid.tile(i);
    const auto document = maker_.document(tree_, tile);
    if (!document) return tl::unexpected(document.error());
    const auto bytes = exchange::glb_bytes(*document);
    if (!bytes) return tl::unexpected(bytes.error());
    if (auto ok = core::replace_file(file("content", tile, "glb"), *bytes); !ok) return ok;
    const core::Bounds box = bounds_of(*document);
    const std::lock_guard lock(mutex_);
    grid.boxes[i] =
        Box{document->origin + glm::dvec3(box.min), document->origin + glm::dvec3(box.max)};
    ++report_.contents;
    report_.triangles += document->triangle_count();
    report_.bytes += bytes->size();
    return {};
  }

  // Processes tiles one by one until none are left or one fails.
  void work(Grid& grid) {
    core::Result<void> result{};
    while (result && !failed_.load(std::memory_order_relaxed)) {
      if (options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed)) {
        result =
            core::fail(core::ErrorCode::kInterrupted, "interrupted: the tileset is incomplete");
        break;
      }
      const std::size_t i = next_.fetch_add(1, std::memory_order_relaxed);
      if (i >= grid.count()) return;
      try {
        result = write_content(grid, i);
      } catch (const std::bad_alloc&) {
        result = core::fail(core::ErrorCode::kOutOfMemory, core::out_of_memory("a tile"));
      }
    }
    failed_.store(true, std::memory_order_relaxed);
    const std::lock_guard lock(mutex_);
    if (!result && !error_) error_ = result.error();
  }

  core::Result<void> write_contents(Grid& grid) {
    next_.store(0, std::memory_order_relaxed);
    core::run_in_threads(std::min<std::size_t>(options_.threads, grid.count()),
                         [this, &grid] { work(grid); });
    if (error_) return tl::unexpected(*error_);
    if (options_.progress)
      options_.progress(static_cast<double>(report_.contents) / static_cast<double>(total_));
    return {};
  }

  // Extends each tile's box to enclose those of its children.
  void enclose_children(Grid& grid) {
    if (grid.first.level + 1 == tree_.level_count()) return;
    Grid& below = grids_[static_cast<std::size_t>(grid.first.level) + 1];
    for (std::size_t i = 0; i < below.count(); ++i) {
      const Tile child = below.tile(i);
      std::optional<Box>& box = grid.box({grid.first.level, child.x / 2, child.y / 2});
      const Box& inner = *below.boxes[i];
      box = box ? Box{glm::min(box->min, inner.min), glm::max(box->max, inner.max)} : inner;
    }
  }

  core::Result<void> write_subtrees(const Grid& grid) {
    for (std::size_t i = 0; i < grid.count(); ++i) {
      const Tile root = grid.tile(i);
      const std::string bytes = subtree_bytes(tree_, root, [this](const Tile& tile) {
        return tile_box(*grids_[static_cast<std::size_t>(tile.level)].box(tile));
      });
      if (auto ok = core::replace_file(file("subtrees", root, "subtree"), bytes); !ok) return ok;
      ++report_.subtrees;
    }
    return {};
  }

  // The box of the whole square, as implicit tiling subdivides it, with the heights of all tiles.
  std::string tileset_json() {
    const Box& all = *grids_.front().boxes.front();
    const double side_m = static_cast<double>(tree_.side_blocks()) * world_.block_size_m();
    const Box square{{0, all.min.y, 0}, {side_m, all.max.y, side_m}};
    const double error_m = maker_.error_m(tree_.node_level({0, 0, 0}));
    return fmt::format(
        R"({{"asset":{{"version":"1.1","generator":"psygen"}},"schema":{},"geometricError":{},)"
        R"("root":{{{}"boundingVolume":{{"box":[{}]}},"geometricError":{},"refine":"REPLACE",)"
        R"("content":{{"uri":"content/{{level}}/{{x}}/{{y}}.glb"}},"implicitTiling":{{)"
        R"("subdivisionScheme":"QUADTREE","availableLevels":{},"subtreeLevels":{},)"
        R"("subtrees":{{"uri":"subtrees/{{level}}/{{x}}/{{y}}.subtree"}}}}}}}})"
        "\n",
        kSchema, 2 * error_m, options_.at_geo ? transform_json(*options_.at_geo) : "",
        fmt::join(tile_box(square), ","), error_m, tree_.level_count(), kSubtreeLevels);
  }

  const world::World& world_;
  const TileTree& tree_;
  const std::filesystem::path& folder_;
  const TilesetOptions& options_;
  const TileMaker maker_;
  std::vector<Grid> grids_;  // by level
  std::uint64_t total_ = 0;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> failed_{false};
  std::mutex mutex_;
  std::optional<core::Error> error_;
  TilesetReport report_;
};

}  // namespace

core::Result<GeoPlace> parse_geo_place(const std::string& text) {
  std::array<double, 3> numbers{};
  std::size_t count = 0;
  const char* at = text.data();
  const char* const end = at + text.size();
  for (; count < numbers.size(); ++count) {
    const auto parsed = std::from_chars(at, end, numbers[count]);
    if (parsed.ec != std::errc()) break;
    at = parsed.ptr;
    if (at == end || *at != ',') {
      ++count;
      break;
    }
    ++at;
  }
  const auto [latitude, longitude, height_m] = numbers;
  if (count >= 2 && at == end && text.back() != ',' && std::abs(latitude) <= 90 &&
      std::abs(longitude) <= 180 && height_m >= -12'000 && height_m <= 1e6)
    return GeoPlace{latitude, longitude, height_m};
  return core::invalid_argument(
      fmt::format("'{}' is not LATITUDE,LONGITUDE[,HEIGHT]: -90 to 90 and -180 to 180 degrees, "
                  "-12000 to 1000000 m",
                  core::shown(text, 60)));
}

core::Result<TilesetReport> write_tileset(const world::World& world,
                                          const models::Registry& registry, const TileTree& tree,
                                          const std::filesystem::path& folder,
                                          const TilesetOptions& options) {
  return Writer(world, registry, tree, folder, options).write();
}

}  // namespace psygen::tiles
