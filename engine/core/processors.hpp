// The number of processors that this process may use: by its affinity (taskset, cpusets) and by the
// quotas of control groups (containers, batch systems). std::thread::hardware_concurrency() knows
// no quota, so threads that are counted by it wait for each other. An answer holds only for the
// moment. Linux. Any thread.
#pragma once

#include <filesystem>
#include <optional>

namespace psygen::core {

// Processors that the affinity of the calling thread allows, at least 1.
unsigned allowed_processors();

// Processors whose time the control groups of this process grant it: the smallest quota of its
// group and of all groups around it, of version 2 (`cpu.max`) and version 1 (`cpu.cfs_quota_us`).
// Nothing without a quota. Reads /proc/self and /sys/fs/cgroup below `root`. It sees no groups
// outside of the process's container.
std::optional<double> processor_quota(const std::filesystem::path& root = "/");

// `processors`, or the quota rounded up if that is less; at least 1.
unsigned within_quota(unsigned processors, const std::filesystem::path& root = "/");

// The number of threads that can run at the same time: allowed_processors() within the quota.
inline unsigned usable_processors() {
  return within_quota(allowed_processors());
}

}  // namespace psygen::core
