#include "engine/core/processors.hpp"

#ifdef __linux__
#include <sched.h>
#endif

#include <algorithm>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <string>
#include <thread>

namespace psygen::core {
namespace {

namespace fs = std::filesystem;

// The first two words of a file that are positive numbers, as quota and period; nothing for "max",
// for −1, and for files that cannot be read.
std::optional<double> quota_in(const fs::path& quota_file, const fs::path& period_file) {
  std::ifstream quota_stream(quota_file), period_stream(period_file);
  double quota = 0, period = 0;
  if (!(quota_stream >> quota)) return std::nullopt;
  if (!((quota_file == period_file ? quota_stream : period_stream) >> period)) return std::nullopt;
  if (!(quota > 0 && period > 0)) return std::nullopt;
  return quota / period;
}

// The smaller one of two quotas, of which either may be missing.
std::optional<double> smaller(std::optional<double> a, std::optional<double> b) {
  return a && b ? std::min(*a, *b) : a ? a : b;
}

// The smallest quota of `group` and the groups around it in a hierarchy mounted at `top`.
std::optional<double> quota_of_groups(const fs::path& top, fs::path group) {
  std::optional<double> least;
  for (;; group = group.parent_path()) {
    const fs::path folder = top / group;
    least = smaller(least, quota_in(folder / "cpu.max", folder / "cpu.max"));
    least = smaller(least, quota_in(folder / "cpu.cfs_quota_us", folder / "cpu.cfs_period_us"));
    if (group.empty()) return least;
  }
}

}  // namespace

unsigned allowed_processors() {
#ifdef __linux__
  cpu_set_t set;
  CPU_ZERO(&set);
  // It fails on machines with more processors than the set has.
  if (sched_getaffinity(0, sizeof(set), &set) == 0)
    return std::max(static_cast<unsigned>(CPU_COUNT(&set)), 1U);
#endif
  return std::max(std::thread::hardware_concurrency(), 1U);
}

std::optional<double> processor_quota(const fs::path& root) {
  std::optional<double> least;
  const fs::path mounts = root / "sys/fs/cgroup";
  std::ifstream groups(root / "proc/self/cgroup");
  // "NUMBER:CONTROLLERS:GROUP"; version 2 has no controllers there.
  for (std::string line; std::getline(groups, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const fs::path group = fs::path(line.substr(second + 1)).relative_path();
    // Systems with both versions mount version 2 in a folder beside the others. Folders of several
    // controllers may have another order in their name, but also a link for each.
    if (controllers.empty())
      for (const char* folder : {"", "unified"})
        least = smaller(least, quota_of_groups(mounts / folder, group));
    else if (("," + controllers + ",").find(",cpu,") != std::string::npos)
      for (const std::string& folder : {controllers, std::string("cpu")})
        least = smaller(least, quota_of_groups(mounts / folder, group));
  }
  return least;
}

unsigned within_quota(unsigned processors, const fs::path& root) {
  const auto quota = processor_quota(root);
  const double most = std::min<double>(processors, std::ceil(quota.value_or(processors)));
  return std::max(static_cast<unsigned>(most), 1U);
}

}  // namespace psygen::core
