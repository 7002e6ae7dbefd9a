#include "engine/core/data_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <utility>

namespace psygen::core {
namespace {

namespace fs = std::filesystem;

constexpr const char* kVariable = "PSYGEN_DATA";

// Adds the folder unless the list has it already.
void add(std::vector<fs::path>& folders, const fs::path& folder) {
  if (folder.empty()) return;
  const fs::path plain = folder.lexically_normal();
  if (std::ranges::find(folders, plain) == folders.end()) folders.push_back(plain);
}

void add_variable(std::vector<fs::path>& folders) {
  const char* value = std::getenv(kVariable);
  std::string_view rest = value != nullptr ? value : "";
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    add(folders, rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
}

void add_installed(std::vector<fs::path>& folders, const fs::path& built_with) {
  std::error_code error;
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    add(folders, executable.parent_path());
    add(folders, executable.parent_path() / PSYGEN_DATA_FROM_EXECUTABLE);
  }
  add(folders, built_with);
}

}  // namespace

std::vector<fs::path> data_folders(const fs::path& given, const fs::path& built_with) {
  std::vector<fs::path> folders;
  add(folders, given);
  add_variable(folders);
  add_installed(folders, built_with);
  return folders;
}

std::vector<fs::path> installed_folders(const fs::path& name, const fs::path& built_with) {
  std::vector<fs::path> folders;
  add_installed(folders, built_with);
  for (fs::path& folder : folders)
    folder /= name;
  return folders;
}

Result<fs::path> data_file(const fs::path& name, const fs::path& given,
                           const fs::path& built_with) {
  if (name.empty() || name.is_absolute() || std::ranges::find(name, "..") != name.end()) {
    return invalid_argument(
        fmt::format("\"{}\": the name of a data file must be a path without \"..\" that is "
                    "relative to a data folder",
                    name.string()));
  }
  const std::vector<fs::path> folders = data_folders(given, built_with);
  std::string looked;
  for (const fs::path& folder : folders) {
    std::error_code error;
    if (fs::is_regular_file(folder / name, error)) return folder / name;
    looked += fmt::format("{}{}", looked.empty() ? "" : ", ", folder.string());
  }
  return fail(ErrorCode::kIo,
              fmt::format("{}: no such data file; looked in {} (set {} to add folders)",
                          name.string(), looked, kVariable));
}

Result<fs::path> user_folder_path(UserFolder folder, const std::string& program,
                                  const fs::path& given) {
  constexpr std::pair<const char*, const char*> kPlaces[] = {{"XDG_DATA_HOME", ".local/share"},
                                                             {"XDG_CONFIG_HOME", ".config"},
                                                             {"XDG_STATE_HOME", ".local/state"}};
  const auto [variable, below_home] = kPlaces[static_cast<std::size_t>(folder)];
  const char* named = std::getenv(variable);
  const char* home = std::getenv("HOME");
  fs::path found = given;
  if (found.empty() && named != nullptr && *named == '/') {
    found = fs::path(named) / program;
  } else if (found.empty() && home != nullptr && *home == '/') {
    found = fs::path(home) / below_home / program;
  }
  if (found.empty())
    return fail(ErrorCode::kIo,
                fmt::format("no folder for {}: neither {} nor HOME is set", program, variable));
  return found;
}

Result<fs::path> user_folder(UserFolder folder, const std::string& program, const fs::path& given) {
  return user_folder_path(folder, program, given).and_then([](fs::path found) -> Result<fs::path> {
    std::error_code error;
    fs::create_directories(found, error);
    if (error) return fail(ErrorCode::kIo, fmt::format("{}: {}", found.string(), error.message()));
    return found;
  });
}

std::string_view version() {
  return PSYGEN_VERSION;
}

}  // namespace psygen::core
