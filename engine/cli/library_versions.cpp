#include "engine/cli/library_versions.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <gnu/libc-version.h>
#include <link.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <sstream>
#include <utility>

#include "engine/core/utf8.hpp"
#include "engine/image/picture_codec.hpp"

namespace psygen::cli {
namespace {

namespace fs = std::filesystem;

// The file names of the libraries in this process, without links.
std::vector<std::string> loaded_libraries() {
  std::vector<std::string> names;
  const auto add = [](dl_phdr_info* info, std::size_t, void* list) {
    std::error_code error;
    const fs::path file = fs::canonical(info->dlpi_name, error);
    if (!error) static_cast<std::vector<std::string>*>(list)->push_back(file.filename());
    return 0;
  };
  dl_iterate_phdr(add, &names);
  return names;
}

// The library of a package among those that are loaded: "glfw3" is libglfw.so.3.3. Empty for a
// package without one.
std::string file_of(const std::string& package, const std::vector<std::string>& loaded) {
  const std::string stem =
      "lib" + core::lower_ascii(package.substr(0, package.find_last_not_of("0123456789") + 1));
  const auto found = std::ranges::find_if(
      loaded, [&](const std::string& file) { return core::lower_ascii(file).starts_with(stem); });
  return found == loaded.end() ? "" : *found;
}

// The version that a function of a loaded library tells. Empty without the function.
std::string told_version(const char* function) {
  auto* const tell = reinterpret_cast<const char* (*)()>(dlsym(RTLD_DEFAULT, function));
  return tell != nullptr ? tell() : "";
}

std::string version_of_vulkan_loader() {
  void* const loader = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);
  if (loader == nullptr) return {};
  auto* const tell =
      reinterpret_cast<int (*)(std::uint32_t*)>(dlsym(loader, "vkEnumerateInstanceVersion"));
  std::uint32_t version = 0;
  if (tell == nullptr || tell(&version) != 0) return {};
  return fmt::format("{}.{}.{}", version >> 22, version >> 12 & 0x3FF, version & 0xFFF);
}

}  // namespace

std::vector<LibraryVersion> library_versions() {
  const auto codec = image::picture_codec();  // loads OpenImageIO
  const std::vector<std::string> loaded = loaded_libraries();
  std::vector<LibraryVersion> found;
  std::istringstream packages(PSYGEN_PACKAGE_VERSIONS);  // "fmt=9.1.0 glfw3=3.3.8"
  for (std::string package; packages >> package;) {
    const std::size_t end = package.find('=');
    LibraryVersion library{package.substr(0, end), package.substr(end + 1), {}};
    if (library.name == "Vulkan") library.loaded = version_of_vulkan_loader();
    if (library.name == "glfw3") library.loaded = told_version("glfwGetVersionString");
    if (library.name == "SQLite3") library.loaded = told_version("sqlite3_libversion");
    if (library.loaded.empty()) library.loaded = file_of(library.name, loaded);
    found.push_back(std::move(library));
  }
  found.push_back({"C library", {}, gnu_get_libc_version()});
  const std::string reason = codec ? "" : "not loaded: " + codec.error().message;
  found.push_back({"OpenImageIO", {}, codec ? file_of("OpenImageIO", loaded) : reason});
  return found;
}

}  // namespace psygen::cli
