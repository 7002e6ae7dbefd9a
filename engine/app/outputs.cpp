// Writes the outputs of a flight: the facts of the summary and the files of the output folder.
#include <fmt/format.h>

#include "engine/amplify/block_synthesiser.hpp"
#include "engine/app/flight.hpp"
#include "engine/app/virtual_frame.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/models/registry.hpp"
#include "engine/render/preset.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/settings.hpp"
#include "engine/synthesis/mesh_supply.hpp"
#include "engine/telemetry/marks.hpp"
#include "engine/telemetry/own_figures.hpp"
#include "engine/telemetry/process.hpp"
#include "engine/telemetry/report.hpp"
#include "engine/telemetry/trace_log.hpp"
#include "engine/world/world.hpp"

namespace psygen::app {
namespace {

constexpr int kFloorRepeats = 15;
constexpr std::size_t kFloorFrames =
    31;  // last frames of the flight that the floor is compared with

telemetry::Count count_of(double value) {
  if (value < 0x1.0p64) return static_cast<std::uint64_t>(value);
  return telemetry::Count::missing("more than 2^64");
}

telemetry::WorldFacts world_facts(const world::World& world, const models::Registry& registry) {
  telemetry::WorldFacts facts;
  facts.name = world.name;
  facts.seed = world.seed;
  facts.blocks = {static_cast<std::int64_t>(world.blocks_x),
                  static_cast<std::int64_t>(world.blocks_z)};
  const world::WorldSize size = world::world_size(world, registry);
  facts.block_m = world.block_size_m();
  facts.block_models = size.block_models;
  facts.block_triangles = size.block_triangles;
  facts.block_bytes = size.block_bytes;
  if (size.endless) {
    const auto endless = telemetry::Count::missing("the world is endless");
    facts.triangles = facts.bytes_paper = facts.bytes = endless;
  } else {
    facts.triangles = count_of(size.triangles);
    facts.bytes_paper = count_of(size.bytes_paper);
    facts.bytes = count_of(size.bytes);
  }
  return facts;
}

// Median time of the last timed frames divided by the time of the last frame's draw lists alone.
telemetry::Figure floor_ratio(const telemetry::FrameLog& log, render::Renderer& renderer) {
  const auto frames = log.frames();
  std::vector<double> last;
  for (auto frame = frames.rbegin(); frame != frames.rend() && last.size() < kFloorFrames; ++frame)
    if (frame->apart == telemetry::Apart::kNo) last.push_back(frame->frame_ms);
  if (last.size() < kFloorFrames) {
    return telemetry::Figure::missing(fmt::format("fewer than {} timed frames", kFloorFrames));
  }
  const auto floor_ms = renderer.replay_floor_ms(kFloorRepeats);
  if (!floor_ms) return telemetry::Figure::missing(floor_ms.error().message);
  std::ranges::nth_element(last, last.begin() + kFloorFrames / 2);
  return last[kFloorFrames / 2] / *floor_ms;
}

std::uint64_t hash_of_types(const models::Registry& registry) {
  std::uint64_t hash = 0;
  for (models::ModelIndex i = 0; i < registry.size(); ++i)
    hash = core::combine(
        core::combine(hash, core::hash_bytes(std::as_bytes(std::span(registry[i].name())))),
        registry[i].identity());
  return hash;
}

telemetry::Count sample_hash(const scene::Scene& scene, core::BlockCoord block) {
  const auto hash = amplify::sample_world_hash(scene.world(), scene.registry(), block);
  return hash ? telemetry::Count(*hash) : telemetry::Count::missing("a model there failed");
}

}  // namespace

// `whole`: the flight was completed. Otherwise draws no frames and synthesises no models for
// measurements.
telemetry::RunFacts Flight::run_facts(bool whole) {
  scene::Scene& scene = session_->scene();
  const SessionOptions& session = session_->options();
  telemetry::RunFacts facts;
  facts.world = world_facts(scene.world(), scene.registry());
  const render::DeviceInfo& device = session_->renderer().device();
  facts.device = {device.name, device.driver, device.api_version, device.timestamps,
                  device.pass_times};
  const core::Extent size = session_->renderer().size();
  facts.run.path = options_.path_file.stem().string();
  facts.run.paradigm = scene::to_string(session.scene.paradigm);
  facts.run.policy = synthesis::name_of(session.scene.policy);
  facts.run.modelers = scene.settings().modelers;
  facts.run.width = size.width;
  facts.run.height = size.height;
  facts.run.lod = session.scene.levels_of_detail;
  facts.run.fixed_step = options_.fixed_step_hz > 0
                             ? telemetry::Figure(options_.fixed_step_hz)
                             : telemetry::Figure::missing("the flight follows the wall clock");
  facts.run.error_pixels = session.scene.max_error_pixels;
  const double target_ms = session.scene.target_frame_ms;
  facts.run.target_fps = target_ms > 0 ? telemetry::Figure(1000 / target_ms)
                                       : telemetry::Figure::missing("no target frame rate");
  facts.machine = telemetry::machine_facts();
  facts.build = telemetry::build_facts();
  facts.load = load_ ? load_->facts() : telemetry::LoadFacts{};
  facts.run.command = telemetry::process_command();
  facts.run.preset = render::to_string(session_->renderer().preset());
  facts.run.view_distance_m = session.scene.view_distance_m;
  const synthesis::CacheStats cache = scene.meshes().stats();
  facts.cache_budget_bytes = cache.budget_bytes;
  facts.cache_peak_bytes = cache.peak_bytes;
  facts.prefetch_hit_percent =
      cache.prefetched > 0 ? telemetry::Figure(100.0 * static_cast<double>(cache.prefetch_hits) /
                                               static_cast<double>(cache.prefetched))
                           : telemetry::Figure::missing("nothing was prefetched");
  facts.share_drawn = cache.triangles > 0
                          ? telemetry::Figure(static_cast<double>(cache.triangles_drawn) /
                                              static_cast<double>(cache.triangles))
                          : telemetry::Figure::missing("nothing was synthesised");
  facts.floor_ratio = telemetry::Figure::missing("the flight failed");
  if (has_virtual_frames(options_.session)) {
    facts.floor_ratio = telemetry::Figure::missing("the clock is virtual");
  } else if (whole) {
    // Nothing else runs during the measurement.
    const bool alone = scene.wait_for_modelers([this] { return !session_->stopped(); });
    facts.floor_ratio = alone ? floor_ratio(*log_, session_->renderer())
                              : telemetry::Figure::missing("the flight was stopped");
  }
  facts.peak_rss_bytes = telemetry::peak_rss_bytes();
  if (facts.peak_rss_bytes.has_value() && peak_before_bytes_.has_value())
    facts.peak_rss_bytes = std::max(*facts.peak_rss_bytes, *peak_before_bytes_);
  facts.reference = reference_load();
  facts.world_hash = !options_.hash_world ? telemetry::Count::missing("switched off")
                     : whole              ? sample_hash(scene, session_->home().position.block)
                                          : telemetry::Count::missing("the flight failed");
  facts.types_hash = hash_of_types(scene.registry());
  facts.path_hash =
      path_ ? telemetry::Count(path_->hash()) : telemetry::Count::missing("the run had no path");
  facts.sections = options_.sections;
  facts.invalid_values = scene.figures().invalid_counts();
  facts.ignored_marks = scene.marks().ignored();
  facts.images_hash = pictures_failed_ ? telemetry::Count::missing("an image was not written")
                      : images_ > 0    ? telemetry::Count(images_hash_)
                                       : telemetry::Count::missing("no images were written");
  return facts;
}

// Before the flight, when the modelers rest. The memory of the load is not that of the flight.
void Flight::measure_reference_load() {
  if (!session_->scene().wait_for_modelers([this] { return !session_->stopped(); })) return;
  peak_before_bytes_ = telemetry::peak_rss_bytes();
  reference_before_ = telemetry::measure_reference_load();
  telemetry::forget_peak_rss();
}

// After the flight, when the modelers rest. Call it after the other facts.
telemetry::ReferenceLoad Flight::reference_load() {
  if (!reference_before_) return {};
  const bool alone = session_->scene().wait_for_modelers([this] { return !session_->stopped(); });
  return alone ? telemetry::mean_of(*reference_before_, telemetry::measure_reference_load())
               : telemetry::ReferenceLoad();
}

void Flight::note_written(const std::filesystem::path& file, const core::Result<void>& result) {
  if (result) {
    report_.files.push_back(file);
  } else {
    report_.failures.push_back(result.error());
  }
}

// The most useful files come first and the largest last, in case the disk fills up.
void Flight::write_outputs(const telemetry::Summary& summary) {
  if (options_.out_folder.empty()) return;
  const auto file = [this](const char* name) { return options_.out_folder / name; };
  note_written(file("summary.json"), core::replace_file(file("summary.json"), to_json(summary)));
  note_written(file("report.html"),
               core::replace_file(file("report.html"), report_html(*log_, summary)));
  note_written(file("frames.csv"), write_frames_csv(file("frames.csv"), *log_));
  note_written(file("trace.json"), session_->trace()->write(file("trace.json")));
}

}  // namespace psygen::app
