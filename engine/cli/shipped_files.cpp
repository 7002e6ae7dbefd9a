#include "engine/cli/shipped_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "engine/core/data_file.hpp"
#include "engine/core/nearest_word.hpp"
#include "engine/handmade/files.hpp"
#include "engine/world/files/world_file.hpp"

namespace psygen::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEnding = ".toml";

std::string_view word_of(Shipped kind) {
  return kind == Shipped::kWorld ? "world" : "path";
}

// Folders that may hold the shipped files of a kind.
std::vector<fs::path> folders_of(Shipped kind) {
  std::vector<fs::path> folders = core::data_folders();
  for (fs::path& folder : folders)
    folder /= fmt::format("{}s", word_of(kind));
  return folders;
}

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

std::vector<std::string> names_in(const std::vector<fs::path>& folders) {
  std::vector<std::string> names;
  for (const fs::path& folder : folders) {
    std::error_code error;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
      if (it->path().extension() == kEnding) names.push_back(it->path().stem().string());
  }
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

bool has_folder(const std::string& name) {
  return name.find('/') != std::string::npos;
}

// Error message for a name without a file.
std::string missing(Shipped kind, const std::string& name, std::vector<fs::path> folders) {
  const std::vector<std::string> names = names_in(folders);
  const std::string suggested = core::suggestion(fs::path(name).stem().string(), names);
  if (has_folder(name)) folders.clear();
  std::error_code error;
  if (fs::path(name).is_relative()) folders.insert(folders.begin(), fs::current_path(error));
  std::string text = fmt::format("{}: no such file; ", name);
  for (const fs::path& folder : folders)
    text += fmt::format("{}{}{}", &folder == &folders.front() ? "looked in " : ", ",
                        folder.string(), &folder == &folders.back() ? "; " : "");
  if (names.empty()) return text + fmt::format("no shipped {} was found", word_of(kind));
  return text +
         fmt::format("the shipped {}s are {}{}", word_of(kind), fmt::join(names, ", "), suggested);
}

}  // namespace

core::Result<fs::path> find_file(Shipped kind, const std::string& name) {
  std::error_code error;
  const fs::file_status status = fs::status(name, error);
  if (fs::is_regular_file(status)) return fs::path(name);
  const std::vector<fs::path> folders = folders_of(kind);
  if (!has_folder(name)) {
    for (const fs::path& folder : folders) {
      for (const std::string& file : {name, name + kEnding})
        if (is_file(folder / file)) return folder / file;
    }
  }
  // A folder or another non-file is reported when it is read.
  if (status.type() != fs::file_type::not_found) return fs::path(name);
  return core::fail(core::ErrorCode::kIo, missing(kind, name, folders));
}

core::Result<world::World> load_world(const std::string& name, models::Registry& registry,
                                      bool quiet) {
  const auto file = find_file(Shipped::kWorld, name);
  if (!file) return tl::unexpected(file.error());
  auto world = world::load_world(*file, registry, &handmade::files());
  if (world && !quiet) world::log_warnings(*world, name);
  return world;
}

core::Result<world::World> load_world_and_files(const std::string& name, models::Registry& registry,
                                                bool quiet) {
  auto world = load_world(name, registry, quiet);
  if (!world) return world;
  const auto hash = handmade::hash_of_files(*world, *find_file(Shipped::kWorld, name));
  if (!hash) return tl::unexpected(hash.error());
  world->files_hash = *hash;
  return world;
}

}  // namespace psygen::cli
