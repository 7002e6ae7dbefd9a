#include "engine/save/lock_holder.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "engine/core/utf8.hpp"

namespace psygen::save {
namespace {

// The process of a line of /proc/locks such as
//   1: POSIX  ADVISORY  WRITE 1234 08:01:5678 1073741826 1073742335
// if the line is about this file; else 0.
pid_t owner_of(const std::string& line, const std::string& file) {
  std::istringstream words(line);
  std::string number, kind, mode, access, place;
  pid_t owner = 0;
  if (!(words >> number >> kind >> mode >> access >> owner >> place)) return 0;
  return kind == "POSIX" && place == file ? owner : 0;
}

}  // namespace

std::string lock_holder(const std::filesystem::path& file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) return "another program";
  const std::string place =
      fmt::format("{:02x}:{:02x}:{}", major(status.st_dev), minor(status.st_dev), status.st_ino);
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    const pid_t owner = owner_of(line, place);
    if (owner <= 0) continue;
    if (owner == getpid()) return "this program";
    std::ifstream comm(fmt::format("/proc/{}/comm", owner));
    std::string name;
    std::getline(comm, name);
    return name.empty() ? fmt::format("process {}", owner)
                        : fmt::format("process {} ({})", owner, core::shown(name, 40));
  }
  return "another program";
}

}  // namespace psygen::save
