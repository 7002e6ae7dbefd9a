// psygen export: writes a model, a block or a region.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <bit>
#include <charconv>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "engine/amplify/amplify.hpp"
#include "engine/amplify/block_files.hpp"
#include "engine/cli/commands.hpp"
#include "engine/cli/option_checks.hpp"
#include "engine/cli/shipped_files.hpp"
#include "engine/cli/text_values.hpp"
#include "engine/cluster/peers.hpp"
#include "engine/core/log.hpp"
#include "engine/core/nearest_word.hpp"
#include "engine/core/processors.hpp"
#include "engine/core/utf8.hpp"
#include "engine/exchange/unpack.hpp"
#include "engine/exchange/write_document.hpp"
#include "engine/synthesis/synthesise.hpp"
#include "engine/telemetry/output_file.hpp"
#include "engine/telemetry/progress_bar.hpp"
#include "engine/telemetry/units.hpp"
#include "engine/tiles/heightmap.hpp"
#include "engine/tiles/tile_tree.hpp"
#include "engine/tiles/tileset.hpp"

namespace psygen::cli {
namespace {

class ExportCommand final : public Command {
 public:
  explicit ExportCommand(CLI::App& cli);
  int run() override;

 private:
  core::Result<exchange::Document> model_document(const models::Registry& registry,
                                                  const world::Palette& palette) const;
  core::Result<exchange::Document> block_document(const world::World& world,
                                                  const models::Registry& registry) const;
  int export_region(const world::World& world, const models::Registry& registry) const;
  int export_heightmap(const world::World& world, unsigned threads) const;

  std::string model_, world_ = kDefaultWorld, out_;
  std::vector<std::string> settings_;  // name=value
  std::optional<core::BlockCoord> block_;
  int level_ = 0;
  std::optional<amplify::Region> region_;
  std::string format_ = "3dtiles";  // of a region
  std::optional<tiles::NodeLevels> levels_;
  unsigned threads_ = 0;
  std::optional<tiles::GeoPlace> at_geo_;
  std::optional<glm::dvec2> range_m_;  // of a heightmap: black and white
};

core::Result<glm::dvec2> parse_range(const std::string& text) {
  const auto range = parse_place(text);  // two numbers
  if (range && range->x < range->y) return range;
  return core::invalid_argument(
      fmt::format("'{}' is not LOW,HIGH in metres, LOW below HIGH", core::shown(text, 60)));
}

constexpr std::size_t kMaxShownBytes = 60;  // of a value

core::Result<exchange::Format> format_of(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  const auto format = exchange::format_from(extension.empty() ? "" : extension.substr(1));
  if (!format)
    return core::invalid_argument(fmt::format("{}: the name must end in .glb or .obj", file));
  return *format;
}

// The files of a world's models. A shipped world's lie elsewhere, where nothing is written.
std::vector<std::filesystem::path> model_files(const world::World& world,
                                               const std::filesystem::path& world_file) {
  std::vector<std::filesystem::path> files;
  for (const world::HandmadeModel& model : world.models)
    files.push_back(world_file.parent_path() / model.file);
  return files;
}

std::vector<std::string_view> model_names(const models::Registry& registry) {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < registry.size(); ++i)
    names.push_back(registry[static_cast<models::ModelIndex>(i)].name());
  return names;
}

std::vector<std::string_view> parameter_names(const models::ModelType& type) {
  std::vector<std::string_view> names;
  for (const models::ParameterSpec& spec : type.parameters())
    names.push_back(spec.name);
  return names;
}

template <class Number>
bool parse(std::string_view text, Number& value) {
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, value);
  return parsed.ec == std::errc() && parsed.ptr == end;
}

// Returns true if all 64 bits are valid. Such values may be given without a sign, so that seeds are
// accepted as they are printed.
bool has_any_bits(const models::ParameterSpec& spec) {
  return spec.hard_min <= -0x1.0p63 && spec.hard_max >= 0x1.0p63;
}

bool set_value(const models::ParameterSpec& spec, std::string_view text, models::Parameters& p,
               std::size_t i) {
  std::int64_t integer = 0;
  std::uint64_t bits = 0;
  double real = 0;
  if (spec.type == models::ParameterType::kReal) {
    if (!parse(text, real)) return false;
    p.set_real(i, real);
  } else if (parse(text, integer)) {
    p.set_integer(i, integer);
  } else {
    if (!has_any_bits(spec) || !parse(text, bits)) return false;
    p.set_integer(i, std::bit_cast<std::int64_t>(bits));
  }
  return true;
}

std::string wanted_by(const models::ParameterSpec& spec) {
  if (spec.type == models::ParameterType::kReal)
    return fmt::format("a number from {:g} to {:g}", spec.hard_min, spec.hard_max);
  if (has_any_bits(spec)) return fmt::format("an integer from {} to {}", INT64_MIN, UINT64_MAX);
  return fmt::format("an integer from {:.0f} to {:.0f}", spec.hard_min, spec.hard_max);
}

// "name=value" into `p`.
core::Result<void> set(const models::ModelType& type, models::Parameters& p,
                       const std::string& setting) {
  const auto shown = [](std::string_view text) { return core::shown(text, kMaxShownBytes); };
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos)
    return core::invalid_argument(fmt::format("'{}' is not name=value", shown(setting)));
  const std::string name = setting.substr(0, equals), text = setting.substr(equals + 1);
  const int index = models::parameter_index(type, name);
  if (index < 0) {
    const std::vector<std::string_view> names = parameter_names(type);
    return core::invalid_argument(fmt::format("{} has no parameter '{}'; its parameters are {}{}",
                                              type.name(), shown(name), fmt::join(names, ", "),
                                              core::suggestion(name, names)));
  }
  const auto i = static_cast<std::size_t>(index);
  const models::ParameterSpec& spec = type.parameters()[i];
  if (set_value(spec, text, p, i)) return {};
  return core::invalid_argument(
      fmt::format("{}: {} must be {}, not '{}'", type.name(), name, wanted_by(spec), shown(text)));
}

core::Result<void> set_all(const models::ModelType& type, models::Parameters& p,
                           const std::vector<std::string>& settings) {
  std::set<std::string> names;
  for (const std::string& setting : settings) {
    if (auto ok = set(type, p, setting); !ok) return ok;
    const std::string name = setting.substr(0, setting.find('='));
    if (!names.insert(name).second)
      return core::invalid_argument(fmt::format("{}: {} is set twice", type.name(), name));
  }
  return models::validate(type, p);
}

core::Result<void> check_level(const models::ModelType& type, int level) {
  if (level < type.level_count()) return {};
  return core::invalid_argument(
      fmt::format("the levels of {} are 0 to {}", type.name(), type.level_count() - 1));
}

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

ExportCommand::ExportCommand(CLI::App& cli)
    : Command(cli, "export", "Write a model, a block or a region") {
  CLI::App& c = *command_;
  auto* model = c.add_option("--model", model_, "Name of a model type");
  c.add_option("--set", settings_,
               "name=value: a parameter of the model; may be given several times")
      ->needs(model);
  auto* block = add_parsed(c, "--block", block_, parse_block, "X,Z",
                           "Block X,Z of the world, with all its models")
                    ->excludes(model);
  c.add_option("--world", world_, "World of the block, or of the model's species")
      ->capture_default_str();
  c.add_option("--level", level_, "Level of detail; 0 is full")->transform(integer_between(0, 31));
  auto* region =
      add_parsed(
          c, "--region", region_, amplify::parse_region, "REGION",
          "Blocks X0,Z0,X1,Z1 of the world, excluding X1 and Z1, as one tileset for streaming")
          ->excludes(model)
          ->excludes(block);
  c.add_option("--format", format_, "Output format of a region")
      ->check(one_of({"3dtiles", "heightmap"}))
      ->capture_default_str()
      ->needs(region);
  add_parsed(c, "--levels", levels_, tiles::parse_levels, "LEVELS",
             "FINEST-COARSEST level of a region's tiles; a tile of level k has 2^k x 2^k blocks; "
             "default: from 0 to a single tile")
      ->needs(region);
  add_parsed(
      c, "--at-geo", at_geo_, tiles::parse_geo_place, "PLACE",
      "LATITUDE,LONGITUDE[,HEIGHT] of a tileset's north-western corner, in degrees and metres "
      "(WGS 84); default: none")
      ->needs(region);
  add_parsed(
      c, "--range", range_m_, parse_range, "LOW,HIGH",
      "LOW,HIGH: heights of black and white in a heightmap's heights.png, in metres; default: the "
      "region's lowest and highest point")
      ->needs(region);
  c.add_option("--threads", threads_, "Threads for a region; default: one per usable processor")
      ->transform(integer_between(1, amplify::kMaxThreads))
      ->needs(region);
  c.add_option("--out", out_, "Output file: .glb or .obj; output folder for a region")->required();
  c.callback([this] {
    if (model_.empty() && !block_ && !region_)
      throw CLI::RequiredError("psygen export: one of --model, --block and --region");
    const bool is_heightmap = format_ == "heightmap";
    if (range_m_ && !is_heightmap)
      throw CLI::ValidationError("--range", "is for --format heightmap");
    if (at_geo_ && is_heightmap) throw CLI::ValidationError("--at-geo", "is for --format 3dtiles");
    if (region_) return;
    if (const auto format = format_of(out_); !format)
      throw CLI::ValidationError("--out", format.error().message);
  });
}

int ExportCommand::run() {
  models::Registry registry = models::make_standard_registry();
  std::optional<world::World> world;
  if (block_ || region_ || command_->count("--world") > 0) {
    auto loaded = load_world(world_, registry);
    if (!loaded) return fail_with(loaded.error());
    world = std::move(*loaded);
  }
  if (region_) return export_region(*world, registry);
  const auto inputs = world ? model_files(*world, world_) : std::vector<std::filesystem::path>{};
  if (auto ok = telemetry::check_no_input(out_, inputs); !ok) return fail_with(ok.error());
  if (auto ok = telemetry::check_output_file(out_); !ok) return fail_with(ok.error());
  const auto document =
      block_ ? block_document(*world, registry)
             : model_document(registry, world ? world::drawn_palette(*world) : world::Palette{});
  if (!document) {
    core::log_error(document.error().message);
    const bool usage = !block_ && document.error().code == core::ErrorCode::kInvalidArgument;
    return usage ? kUsage : exit_code_of(document.error());
  }
  if (auto ok = exchange::write_scene(out_, *format_of(out_), *document); !ok)
    return fail_with(ok.error());
  const std::size_t objects = document->objects.size();
  core::log_info(fmt::format("wrote {}: {} object{}, {} vertices, {} triangles", out_, objects,
                             objects == 1 ? "" : "s", document->vertex_count(),
                             document->triangle_count()));
  return kOk;
}

core::Result<exchange::Document> ExportCommand::model_document(
    const models::Registry& registry, const world::Palette& palette) const {
  const int found = registry.find(model_);
  if (found < 0) {
    const std::vector<std::string_view> names = model_names(registry);
    return core::invalid_argument(
        fmt::format("unknown model '{}'; the models are {}{}", core::shown(model_, kMaxShownBytes),
                    fmt::join(names, ", "), core::suggestion(model_, names)));
  }
  const models::ModelType& type = registry[static_cast<models::ModelIndex>(found)];
  models::Parameters p = models::default_parameters(type);
  if (auto ok = set_all(type, p, settings_); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_level(type, level_); !ok) return tl::unexpected(ok.error());
  const auto mesh = synthesis::HeapDestination::make(type, p, level_);
  if (!mesh) return tl::unexpected(mesh.error());
  const auto outcome = synthesis::synthesise_guarded(type, p, level_, mesh->view());
  if (!outcome.ok) return core::fail(core::ErrorCode::kSynthesisFailed, outcome.error);
  auto object = exchange::unpack(type, p, level_, mesh->size(), mesh->view(), palette);
  if (!object) return tl::unexpected(object.error());
  exchange::Document document{model_, {}};
  document.objects.push_back(std::move(*object));
  return document;
}

core::Result<exchange::Document> ExportCommand::block_document(
    const world::World& world, const models::Registry& registry) const {
  const std::int64_t x = block_->x, z = block_->z;
  if (auto ok = amplify::check_region(world, {x, z, x + 1, z + 1}); !ok)
    return core::fail(ok.error().code,
                      fmt::format("the world has no block {},{}: {}", x, z, ok.error().message));
  return amplify::block_document(world, registry, *block_, level_);
}

int ExportCommand::export_region(const world::World& world,
                                 const models::Registry& registry) const {
  if (auto ok = amplify::check_region(world, *region_); !ok) return fail_with(ok.error());
  if (auto ok = cluster::check_one_copy("export the whole region"); !ok)
    return fail_with(ok.error());
  const unsigned threads =
      threads_ > 0 ? threads_ : amplify::threads_for(core::usable_processors());
  if (format_ == "heightmap") return export_heightmap(world, threads);
  const auto tree = tiles::TileTree::over(*region_, levels_.value_or(all_levels(*region_)));
  if (!tree) return fail_with(tree.error());
  tiles::TilesetOptions options;
  options.threads = threads;
  options.stop = &stop_at_interrupt();
  options.at_geo = at_geo_;
  telemetry::ProgressBar bar(telemetry::stderr_terminal(), "tiling " + world.name, 1);
  options.progress = [&bar](double done) { bar.update(done); };
  const auto report = tiles::write_tileset(world, registry, *tree, out_, options);
  if (!report) return fail_with(report.error());
  core::log_info(fmt::format("wrote {}: {} tiles in {} levels, {} triangles, {}", out_,
                             report->contents, tree->level_count(), report->triangles,
                             telemetry::size_text(static_cast<double>(report->bytes))));
  if (!at_geo_)
    core::log_info(
        "note: the tileset has no place on Earth, so globes show it at the Earth's centre; "
        "--at-geo LATITUDE,LONGITUDE[,HEIGHT] gives it one");
  return kOk;
}

int ExportCommand::export_heightmap(const world::World& world, unsigned threads) const {
  tiles::HeightmapOptions options{.threads = threads, .stop = &stop_at_interrupt()};
  if (range_m_) options.range_m = std::pair{range_m_->x, range_m_->y};
  const auto report = tiles::write_heightmap(world, *region_, out_, options);
  if (!report) return fail_with(report.error());
  core::log_info(fmt::format("wrote {}: {} x {} heights from {:.1f} to {:.1f} m", out_,
                             report->width, report->height, report->min_m, report->max_m));
  return kOk;
}

std::unique_ptr<Command> make_export_command(CLI::App& cli) {
  return std::make_unique<ExportCommand>(cli);
}

}  // namespace psygen::cli
