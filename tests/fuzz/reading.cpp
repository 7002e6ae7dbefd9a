#include "tests/fuzz/reading.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include "engine/core/assert.hpp"
#include "engine/core/utf8.hpp"
#include "engine/input/bindings_file.hpp"
#include "engine/world/camera_path.hpp"
#include "engine/world/files/path_file.hpp"
#include "engine/world/files/world_file.hpp"
#include "engine/world/world.hpp"

namespace psygen::fuzz {
namespace {

void check_refusal(const core::Error& error, const std::string& file) {
  using enum core::ErrorCode;
  PSYGEN_CHECK(error.code == kParse || error.code == kInvalidArgument || error.code == kOverBudget,
               "a text is refused for what it says");
  PSYGEN_CHECK(error.message.starts_with(file + ":"), "a refusal names the file");
  PSYGEN_CHECK(core::shown(error.message) == error.message, "a refusal can be printed");
  PSYGEN_CHECK(error.message.size() < file.size() + 2000, "a refusal can be read");
}

bool read_as_world(const std::filesystem::path& file) {
  static models::Registry registry = models::make_standard_registry();
  static const std::size_t before = registry.size();
  registry.shrink(before);  // without the species of the text before
  const auto world = world::load_world(file, registry);
  if (!world) {
    check_refusal(world.error(), file.string());
    PSYGEN_CHECK(registry.size() == before, "a refused world registers nothing");
    return false;
  }
  const auto again = world::parse_world(world::write_world(*world, registry), "again", registry);
  PSYGEN_CHECK(again.has_value(), "a world that was read can be written");
  PSYGEN_CHECK(*again == *world, "a world reads back as it was");
  return true;
}

bool read_as_path(const std::filesystem::path& file) {
  static const world::World world = [] {
    const models::Registry registry = models::make_standard_registry();
    return *world::parse_world(
        "format = 1\n[world]\nname = \"flat\"\nseed = 1\nblocks = [0, 0]\nblock_vertices = 4\n"
        "[terrain]\noctaves = 1\n",
        "flat", registry);
  }();
  const auto path = world::load_camera_path(file);
  if (!path) {
    check_refusal(path.error(), file.string());
    return false;
  }
  for (const double share : {0.0, 0.3, 1.0})
    PSYGEN_CHECK(core::is_valid(path->pose_at(share * path->duration_seconds(), world)),
                 "a path has valid poses");
  return true;
}

input::Actions make_actions() {
  using platform::Key;
  input::Actions actions;
  (void)actions.add("jump", {{Key::kSpace}, {platform::PadButton::kA}});
  (void)actions.add("move_x", {{Key::kD}, {input::PadWay::kLeftStickLeft, -1, 0.3F}});
  return actions;
}

bool read_as_bindings(const std::filesystem::path& file) {
  input::Actions actions = make_actions();
  const std::string before = input::bindings_text(actions);
  const auto read = input::load_bindings(file, actions);
  if (!read) {
    check_refusal(read.error(), file.string());
    PSYGEN_CHECK(input::bindings_text(actions) == before, "refused bindings change nothing");
    return false;
  }
  const std::string written = input::bindings_text(actions);
  input::Actions again = make_actions();
  PSYGEN_CHECK(input::apply_bindings(written, "again", again).has_value() &&
                   input::bindings_text(again) == written,
               "bindings read back as they were");
  return true;
}

}  // namespace

std::string example_bindings() {
  return input::bindings_text(make_actions());
}

FileInMemory::FileInMemory() : descriptor_(memfd_create("text", MFD_CLOEXEC)) {
  PSYGEN_CHECK(descriptor_ >= 0, "there is memory for a file");
}

FileInMemory::~FileInMemory() {
  close(descriptor_);
}

void FileInMemory::write(std::string_view text) {
  const bool written =
      ftruncate(descriptor_, 0) == 0 &&
      pwrite(descriptor_, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size());
  PSYGEN_CHECK(written, "a text fits in memory");
}

std::filesystem::path FileInMemory::path() const {
  return fmt::format("/proc/self/fd/{}", descriptor_);
}

int read_as_everything(std::string_view text, FileInMemory& file) {
  file.write(text);
  return int{read_as_world(file.path())} + int{read_as_path(file.path())} +
         int{read_as_bindings(file.path())};
}

}  // namespace psygen::fuzz
