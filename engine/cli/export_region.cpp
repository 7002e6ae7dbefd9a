// psygen export --region: writes a part of a world for other programs to stream.
#include <fmt/format.h>

#include <thread>

#include "engine/cli/export_command.hpp"
#include "engine/cli/interrupt.hpp"
#include "engine/core/log.hpp"
#include "engine/telemetry/progress_bar.hpp"
#include "engine/telemetry/units.hpp"
#include "engine/tiles/heightmap.hpp"
#include "engine/tiles/tileset.hpp"

namespace psygen::cli {
namespace {

// Levels from single blocks to one tile for the region.
tiles::NodeLevels all_levels(const amplify::Region& region) {
  tiles::NodeLevels levels;
  const auto is_one_tile = [&] {
    return region.x0 >> levels.coarsest == (region.x1 - 1) >> levels.coarsest &&
           region.z0 >> levels.coarsest == (region.z1 - 1) >> levels.coarsest;
  };
  while (levels.coarsest < tiles::kMaxNodeLevel && !is_one_tile())
    ++levels.coarsest;
  return levels;
}

}  // namespace

int ExportCommand::export_region(const world::World& world,
                                 const models::Registry& registry) const {
  const auto fail = [](const core::Error& error) {
    core::log_error(error.message);
    return exit_code_of(error);
  };
  if (auto ok = amplify::check_region(world, *region_); !ok) return fail(ok.error());
  const unsigned threads =
      threads_ > 0 ? threads_ : amplify::threads_for(std::thread::hardware_concurrency());
  if (format_ == "heightmap") return export_heightmap(world, threads);
  const auto tree = tiles::TileTree::over(*region_, levels_.value_or(all_levels(*region_)));
  if (!tree) return fail(tree.error());
  tiles::TilesetOptions options;
  options.threads = threads;
  options.stop = &stop_at_interrupt();
  telemetry::ProgressBar bar(telemetry::stderr_terminal(), "tiling " + world.name, 1);
  options.progress = [&bar](double done) { bar.update(done); };
  const auto report = tiles::write_tileset(world, registry, *tree, out_, options);
  if (!report) return fail(report.error());
  core::log_info(fmt::format("wrote {}: {} tiles in {} levels, {} triangles, {}", out_,
                             report->contents, tree->level_count(), report->triangles,
                             telemetry::size_text(static_cast<double>(report->bytes))));
  return kOk;
}

int ExportCommand::export_heightmap(const world::World& world, unsigned threads) const {
  const auto report = tiles::write_heightmap(world, *region_, out_, threads, &stop_at_interrupt());
  if (!report) {
    core::log_error(report.error().message);
    return exit_code_of(report.error());
  }
  core::log_info(fmt::format("wrote {}: {} x {} heights from {:.1f} to {:.1f} m", out_,
                             report->width, report->height, report->min_m, report->max_m));
  return kOk;
}

}  // namespace psygen::cli
