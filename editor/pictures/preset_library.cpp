#include "editor/pictures/preset_library.hpp"

#include <fmt/format.h>

#include <QStandardPaths>
#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <map>
#include <set>
#include <tuple>

#include "engine/core/data_file.hpp"
#include "engine/world/files/text_edit.hpp"
#include "engine/world/files/text_file.hpp"
#include "engine/world/files/text_snippet.hpp"
#include "engine/world/files/toml_values.hpp"

namespace psygen::editor {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOwn = "Mine";
constexpr std::array kHeadings{"Species", "Rocks", "Grasses", "Terrains", "Skies"};  // in order
constexpr double kSmaller = 0.8,
                 kLarger = 1.2;  // size range of a new scatter, of the species' size
constexpr double kDryM = 1;      // height above water

// Returns "Silver birch" for "silver_birch".
std::string title_of(std::string word) {
  std::ranges::replace(word, '_', ' ');
  if (!word.empty()) word[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(word[0])));
  return word;
}

std::string first_comment(std::string_view text) {
  constexpr std::string_view kUsual = "# A preset of psygen";
  while (text.starts_with('#')) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    if (!line.starts_with(kUsual)) {
      const std::size_t begin = line.find_first_not_of("# ");
      return std::string(begin == std::string_view::npos ? "" : line.substr(begin));
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return {};
}

core::Result<Preset> read_preset_file(const fs::path& file, std::string heading) {
  const auto text = world::read_text_file(file);
  if (!text) return tl::unexpected(text.error());
  auto snippet = world::read_preset(*text, file.string());
  if (!snippet) return tl::unexpected(snippet.error());
  const auto table = world::snippet_table(*snippet);
  if (!table) return tl::unexpected(table.error());
  if (table->size() != 1)
    return core::fail(core::ErrorCode::kParse,
                      fmt::format("{}: a preset must be one whole table", file.string()));
  return Preset{.heading = std::move(heading),
                .name = title_of(file.stem().string()),
                .doc = first_comment(*text),
                .table = table->back().key,
                .snippet = *std::move(snippet),
                .file = file};
}

std::optional<double> number_in(std::string_view text, const world::TextPath& path) {
  const auto value = world::value_text(text, path);
  double number = 0;
  if (!value ||
      std::from_chars(value->data(), value->data() + value->size(), number).ec != std::errc())
    return std::nullopt;
  return number;
}

// Quoted names of all species.
std::set<std::string> species_names(std::string_view text) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < world::item_count(text, {"species"}); ++i)
    names.insert(world::value_text(text, {"species", i, "name"}).value_or(""));
  return names;
}

core::Result<std::string> with_species(std::string_view text, const Preset& preset) {
  const std::set<std::string> taken = species_names(text);
  auto changed = world::with_table_appended(text, {"species"}, preset.snippet);
  if (!changed) return changed;
  const world::TextPath added{"species", world::item_count(*changed, {"species"}) - 1};
  std::string name = world::value_text(*changed, added.with("name")).value_or("");
  const std::string plain = name.size() > 2 ? name.substr(1, name.size() - 2) : "species";
  for (int number = 2; taken.contains(name); ++number)
    name = world::toml_string(fmt::format("{}_{}", plain, number));
  changed = world::with_value(*changed, added.with("name"), name);
  if (!changed) return changed;
  std::string scatter = fmt::format("model = {}\ncount = 8\nmax_slope_deg = 36\n", name);
  if (const auto level_m = number_in(text, {"water", "level_m"}))
    scatter += fmt::format("min_height_m = {}\n", world::toml_number(*level_m + kDryM));
  if (const auto size_m = number_in(*changed, added.with("size_m")))
    scatter +=
        fmt::format("size_m = {}\n", world::toml_range(kSmaller * *size_m, kLarger * *size_m));
  return world::with_table_appended(*changed, {"scatter"}, scatter);
}

}  // namespace

fs::path own_library_folder() {
  const QString folder = QStandardPaths::writableLocation(QStandardPaths::AppDataLocation);
  return fs::path(folder.toStdString()) / "library";
}

std::vector<fs::path> library_folders() {
  std::vector<fs::path> folders;
  for (const fs::path& folder : core::data_folders())
    folders.push_back(folder / "library");
  folders.push_back(own_library_folder());
  return folders;
}

std::vector<Preset> load_library(const std::vector<fs::path>& folders,
                                 std::vector<std::string>* problems) {
  // The first folder with a file of this name wins, as for worlds.
  std::map<std::tuple<bool, std::ptrdiff_t, std::string, std::string>, Preset> presets;
  for (const fs::path& folder : folders) {
    const bool own = folder == own_library_folder();
    std::error_code error;
    for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
         it.increment(error)) {
      const fs::path& file = it->path();
      if (file.extension() != ".toml") continue;
      const std::string heading =
          own || file.parent_path() == folder ? kOwn : title_of(file.parent_path().filename());
      auto preset = read_preset_file(file, heading);
      if (preset) {
        const auto order = std::ranges::find(kHeadings, heading) - kHeadings.begin();
        presets.try_emplace({own, order, heading, preset->name}, *std::move(preset));
      } else if (problems != nullptr) {
        problems->push_back(preset.error().message);
      }
    }
  }
  std::vector<Preset> list;
  for (auto& [key, preset] : presets)
    list.push_back(std::move(preset));
  return list;
}

core::Result<std::string> with_preset(std::string_view text, const Preset& preset) {
  if (preset.table == "species") return with_species(text, preset);
  if (preset.table == "scatter")
    return world::with_table_appended(text, {"scatter"}, preset.snippet);
  return world::with_snippet(text, {preset.table}, preset.snippet);
}

}  // namespace psygen::editor
