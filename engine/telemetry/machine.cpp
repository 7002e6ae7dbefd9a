#include "engine/telemetry/machine.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/clock.hpp"
#include "engine/core/data_file.hpp"
#include "engine/core/processors.hpp"
#include "engine/core/utf8.hpp"

// Both are defined by the source that psygen_revision() adds to a program.
extern "C" {
__attribute__((weak)) extern const char psygen_program_revision[];
__attribute__((weak)) extern const int psygen_program_is_clean;
}

namespace psygen::telemetry {
namespace {

constexpr std::size_t kMaxTextBytes = 400;

// The first line of a file; nothing if it cannot be read.
std::optional<std::string> first_line(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  if (!std::getline(stream, line)) return std::nullopt;
  return core::shown(line, kMaxTextBytes);
}

// The value of the first line "name : value" of /proc/cpuinfo with one of these names.
std::optional<std::string> cpu_value(const std::filesystem::path& root,
                                     std::initializer_list<std::string_view> names) {
  std::ifstream file(root / "proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos) continue;
    const std::string_view name =
        std::string_view(line).substr(0, line.find_last_not_of(" \t", colon - 1) + 1);
    if (std::ranges::find(names, name) == names.end()) continue;
    const std::size_t value = line.find_first_not_of(" \t", colon + 1);
    if (value != std::string::npos) return line.substr(value);
  }
  return std::nullopt;
}

// The extensions that may change the speed or the instructions of a program.
std::string features_in(const std::string& flags) {
  constexpr std::string_view kKinds[] = {"sse",  "ssse", "avx",  "fma",   "f16c", "bmi", "amx",
                                         "gfni", "aes",  "vaes", "asimd", "sve",  "fphp"};
  std::istringstream words(flags);
  std::vector<std::string> found;
  for (std::string word; words >> word;)
    if (std::ranges::any_of(kKinds, [&](std::string_view kind) { return word.starts_with(kind); }))
      found.push_back(word);
  std::ranges::sort(found);
  std::string text;
  for (const std::string& word : found)
    text += (text.empty() ? "" : " ") + word;
  return text;
}

MeasuredText text_or(std::optional<std::string> text, const char* reason) {
  return text && !text->empty() ? MeasuredText(*text) : MeasuredText::missing(reason);
}

std::string compiler_name() {
#ifdef __clang__
  return fmt::format("Clang {}.{}.{}", __clang_major__, __clang_minor__, __clang_patchlevel__);
#else
  return fmt::format("GCC {}.{}.{}", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__);
#endif
}

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
}

}  // namespace

MachineFacts machine_facts(const std::filesystem::path& root) {
  MachineFacts facts;
  constexpr const char* kNoCpu = "/proc/cpuinfo does not tell it";
  facts.cpu = text_or(cpu_value(root, {"model name", "Model", "CPU part"}), kNoCpu);
  facts.cpu_features =
      text_or(features_in(cpu_value(root, {"flags", "Features"}).value_or("")), kNoCpu);
  facts.cores = core::allowed_processors();
  const auto quota = core::processor_quota(root);
  facts.quota_cores = quota ? Figure(*quota) : Figure::missing("no control group sets one");
  const long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGESIZE);
  facts.memory_bytes = pages > 0 ? Measured<std::uint64_t>(static_cast<std::uint64_t>(pages) *
                                                           static_cast<std::uint64_t>(page_bytes))
                                 : Measured<std::uint64_t>::missing("the system does not tell it");
  facts.governor =
      text_or(first_line(root / "sys/devices/system/cpu/cpu0/cpufreq/scaling_governor"),
              "the system does not set the frequency");
  utsname system{};
  facts.kernel =
      text_or(uname(&system) == 0 ? std::optional<std::string>(system.release) : std::nullopt,
              "the system does not tell it");
  return facts;
}

BuildFacts build_facts() {
  BuildFacts facts;
  facts.version = core::version();
  facts.compiler = compiler_name();
  facts.type = PSYGEN_BUILD_TYPE;
  constexpr const char* kUnknown =
      "the program was built outside of a repository, or without psygen_revision()";
  const bool known = psygen_program_revision != nullptr && *psygen_program_revision != '\0';
  facts.revision = known ? MeasuredText(psygen_program_revision) : MeasuredText::missing(kUnknown);
  facts.clean =
      known ? Measured<bool>(psygen_program_is_clean != 0) : Measured<bool>::missing(kUnknown);
  return facts;
}

LoadMeter::LoadMeter(std::filesystem::path root) : root_(std::move(root)), start_(now()) {
  const auto line = first_line(root_ / "proc/loadavg");
  const double load = line ? std::strtod(line->c_str(), nullptr) : 0;
  before_ = line ? Figure(load) : Figure::missing("/proc/loadavg cannot be read");
}

LoadMeter::Times LoadMeter::now() const {
  Times times;
  std::istringstream words(first_line(root_ / "proc/stat").value_or(""));
  // user, nice, system, idle, iowait, irq, softirq, steal; the guests' times are part of user.
  std::array<double, 8> ticks{};
  std::string name;
  times.known = static_cast<bool>(words >> name >> ticks[0] >> ticks[1] >> ticks[2] >> ticks[3] >>
                                  ticks[4] >> ticks[5] >> ticks[6] >> ticks[7]) &&
                name == "cpu";
  const double second = static_cast<double>(sysconf(_SC_CLK_TCK));
  for (const double count : ticks)
    times.all_s += count / second;
  times.steal_s = ticks[7] / second;
  times.busy_s = times.all_s - times.steal_s - (ticks[3] + ticks[4]) / second;
  rusage own{};
  getrusage(RUSAGE_SELF, &own);
  times.own_s = seconds_of(own.ru_utime) + seconds_of(own.ru_stime);
  times.real_s = core::monotonic_seconds();
  return times;
}

LoadFacts LoadMeter::facts() const {
  const Times end = now();
  LoadFacts facts;
  facts.before = before_;
  facts.cpu_seconds = end.own_s - start_.own_s;
  const double all_s = end.all_s - start_.all_s, real_s = end.real_s - start_.real_s;
  if (!start_.known || !end.known || !(all_s > 0) || !(real_s > 0)) {
    facts.others_cores = facts.steal_percent = Figure::missing("/proc/stat does not tell it");
    return facts;
  }
  const double others_s = end.busy_s - start_.busy_s - *facts.cpu_seconds;
  facts.others_cores = std::max(others_s / real_s, 0.0);
  facts.steal_percent = 100 * std::max(end.steal_s - start_.steal_s, 0.0) / all_s;
  return facts;
}

}  // namespace psygen::telemetry
