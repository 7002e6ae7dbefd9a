// psygen export: one model or one block as glTF or OBJ.
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>

#include "engine/amplify/block_files.hpp"
#include "engine/core/log.hpp"
#include "engine/exchange/unpack.hpp"
#include "engine/synthesis/synthesize.hpp"
#include "game/commands.hpp"
#include "game/option_checks.hpp"
#include "game/text_values.hpp"

namespace psygen::game {
namespace {

tl::unexpected<core::Error> refuse(std::string sentence) {
  return core::fail(core::ErrorCode::kInvalidArgument, std::move(sentence));
}

core::Result<exchange::Format> format_of(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  const auto format = exchange::format_from(extension.empty() ? "" : extension.substr(1));
  if (!format) return refuse(fmt::format("{}: its name must end in .glb or .obj", file));
  return *format;
}

std::string model_names(const models::Registry& registry) {
  std::string names;
  for (std::size_t i = 0; i < registry.size(); ++i)
    names += fmt::format("{}{}", i == 0 ? "" : ", ",
                         registry[static_cast<models::ModelIndex>(i)].name());
  return names;
}

std::string parameter_names(const models::ModelType& type) {
  std::string names;
  for (const models::ParameterSpec& spec : type.parameters())
    names += fmt::format("{}{}", names.empty() ? "" : ", ", spec.name);
  return names;
}

// "name=value" into `p`.
core::Result<void> set(const models::ModelType& type, models::Parameters& p,
                       const std::string& setting) {
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos) return refuse(fmt::format("'{}' is not name=value", setting));
  const std::string name = setting.substr(0, equals);
  const int index = models::parameter_index(type, name);
  if (index < 0) {
    return refuse(fmt::format("{} has no parameter '{}'; it has {}", type.name(), name,
                              parameter_names(type)));
  }
  const auto i = static_cast<std::size_t>(index);
  const char* const first = setting.data() + equals + 1;
  const char* const end = setting.data() + setting.size();
  std::from_chars_result parsed{};
  const bool integer = type.parameters()[i].type == models::ParameterType::kInteger;
  if (integer) {
    std::int64_t value = 0;
    parsed = std::from_chars(first, end, value);
    p.set_integer(i, value);
  } else {
    double value = 0;
    parsed = std::from_chars(first, end, value);
    p.set_real(i, value);
  }
  if (parsed.ec == std::errc() && parsed.ptr == end) return {};
  return refuse(fmt::format("{}: {} must be {}, not '{}'", type.name(), name,
                            integer ? "an integer" : "a number", std::string(first, end)));
}

core::Result<void> check_level(const models::ModelType& type, int level) {
  if (level < type.level_count()) return {};
  return refuse(fmt::format("{} has the levels 0 to {}", type.name(), type.level_count() - 1));
}

}  // namespace

ExportCommand::ExportCommand(CLI::App& cli)
    : command_(cli.add_subcommand("export", "Write a model or a block as glTF or OBJ")) {
  CLI::App& c = *command_;
  auto* model = c.add_option("--model", model_, "Model type, by name");
  c.add_option("--set", settings_, "name=value: a parameter of the model; several times")
      ->needs(model);
  auto* block = c.add_option_function<std::string>(
      "--block", [this](const std::string& text) { block_ = *parse_block(text); },
      "Block X,Z of the world, with everything on it");
  block->check(valid_if(parse_block, "X,Z"))->excludes(model);
  c.add_option("--world", world_, "World file (TOML) of the block, or with the model's species")
      ->capture_default_str();
  c.add_option("--level", level_, "Level of detail; 0 is full")->check(number_between(0, 31));
  c.add_option("--out", out_, "File to write: .glb or .obj")
      ->required()
      ->check(valid_if(format_of, "FILE"));
  c.callback([this] {
    if (model_.empty() && !block_)
      throw CLI::RequiredError("psygen export: one of --model and --block");
  });
}

int ExportCommand::run() const {
  models::Registry registry = models::make_standard_registry();
  std::optional<world::World> world;
  if (block_ || command_->count("--world") > 0) {
    auto loaded = load_world(world_, registry);
    if (!loaded) {
      core::log_error(loaded.error().message);
      return exit_code_of(loaded.error());
    }
    world = std::move(*loaded);
  }
  const auto document =
      block_ ? block_document(*world, registry)
             : model_document(registry, world ? world::drawn_palette(*world) : world::Palette{});
  if (!document) {
    core::log_error(document.error().message);
    const bool usage = !block_ && document.error().code == core::ErrorCode::kInvalidArgument;
    return usage ? kUsage : exit_code_of(document.error());
  }
  if (auto ok = exchange::write_document(out_, *format_of(out_), *document); !ok) {
    core::log_error(ok.error().message);
    return exit_code_of(ok.error());
  }
  core::log_info(fmt::format("wrote {}: {} objects, {} vertices, {} triangles", out_,
                             document->objects.size(), document->vertex_count(),
                             document->triangle_count()));
  return kOk;
}

core::Result<exchange::Document> ExportCommand::model_document(
    const models::Registry& registry, const world::Palette& palette) const {
  const int found = registry.find(model_);
  if (found < 0) {
    return refuse(
        fmt::format("there is no model '{}'; there are {}", model_, model_names(registry)));
  }
  const models::ModelType& type = registry[static_cast<models::ModelIndex>(found)];
  models::Parameters p = models::default_parameters(type);
  for (const std::string& setting : settings_) {
    if (auto ok = set(type, p, setting); !ok) return tl::unexpected(ok.error());
  }
  if (auto ok = models::validate(type, p); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_level(type, level_); !ok) return tl::unexpected(ok.error());
  const auto mesh = synthesis::HeapDestination::make(type, p, level_);
  if (!mesh) return tl::unexpected(mesh.error());
  const auto outcome = synthesis::synthesize_guarded(type, p, level_, mesh->view());
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
    return tl::unexpected(ok.error());
  return amplify::block_document(world, registry, *block_, level_);
}

}  // namespace psygen::game
