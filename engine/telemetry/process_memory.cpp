#include "engine/telemetry/process_memory.hpp"

#include <fstream>
#include <string>

namespace psygen::telemetry {
namespace {

// Lines have the form "VmHWM:     1234 kB".
Measured<std::uint64_t> status_field(const std::string& name) {
  std::ifstream status("/proc/self/status");
  std::string key;
  while (status >> key) {
    std::uint64_t kibibytes = 0;
    if (key == name && status >> kibibytes) return kibibytes * 1024;
    std::getline(status, key);
  }
  return Measured<std::uint64_t>::missing("/proc/self/status has no field " + name);
}

}  // namespace

Measured<std::uint64_t> peak_rss_bytes() {
  return status_field("VmHWM:");
}

}  // namespace psygen::telemetry
