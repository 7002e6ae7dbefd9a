#include "engine/telemetry/machine.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/temporary_folder.hpp"

namespace psygen::telemetry {
namespace {

// A folder that stands for "/".
struct Machine {
  TemporaryFolder root;

  void write(const std::string& file, const std::string& text) const {
    const std::filesystem::path path = root.path() / file;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }
};

TEST(MachineFacts, AreThoseOfTheSystemsFiles) {
  const Machine machine;
  machine.write(
      "proc/cpuinfo",
      "processor\t: 0\nmodel name\t: AMD EPYC 7763\nflags\t\t: fpu sse avx2 bmi1 syscall fma\n");
  machine.write("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "powersave\n");
  const MachineFacts facts = machine_facts(machine.root.path());
  EXPECT_EQ(*facts.cpu, "AMD EPYC 7763");
  EXPECT_EQ(*facts.cpu_features, "avx2 bmi1 fma sse");
  EXPECT_EQ(*facts.governor, "powersave");
  EXPECT_GE(facts.cores, 1U);
  EXPECT_GT(*facts.memory_bytes, 1U << 20);
  EXPECT_FALSE(facts.quota_cores.has_value());
  machine.write("proc/self/cgroup", "0::/\n");
  machine.write("sys/fs/cgroup/cpu.max", "150000 100000\n");
  EXPECT_DOUBLE_EQ(*machine_facts(machine.root.path()).quota_cores, 1.5);
}

TEST(MachineFacts, AreMissingWithAReasonWhereTheSystemIsSilent) {
  const Machine machine;
  const MachineFacts facts = machine_facts(machine.root.path());
  for (const Measured<std::string>& fact : {facts.cpu, facts.cpu_features, facts.governor}) {
    EXPECT_FALSE(fact.has_value());
    EXPECT_FALSE(fact.reason.empty());
  }
}

TEST(LoadMeter, SplitsTheTimesOfTheSystem) {
  const Machine machine;
  machine.write("proc/loadavg", "1.25 0.5 0.1 2/300 4711\n");
  machine.write("proc/stat", "cpu  1000 0 500 8000 100 0 0 50 0 0\n");
  const LoadMeter meter(machine.root.path());
  // 1,000 ticks more: 600 idle, 150 stolen, the rest busy, which this process did not use.
  machine.write("proc/stat", "cpu  1200 0 550 8500 200 0 0 200 0 0\n");
  const LoadFacts facts = meter.facts();
  EXPECT_EQ(*facts.before, 1.25);
  EXPECT_NEAR(*facts.steal_percent, 15, 1e-9);
  EXPECT_GT(*facts.others_cores, 0);
  EXPECT_GE(*facts.cpu_seconds, 0);
}

TEST(LoadMeter, IsSilentWithoutProc) {
  const Machine machine;
  const LoadFacts facts = LoadMeter(machine.root.path()).facts();
  EXPECT_FALSE(facts.before.has_value());
  EXPECT_FALSE(facts.others_cores.has_value());
  EXPECT_FALSE(facts.steal_percent.has_value());
  EXPECT_TRUE(facts.cpu_seconds.has_value());
}

TEST(BuildFacts, NameCompilerAndTypeAndARevisionOnlyIfTheProgramHasOne) {
  const BuildFacts facts = build_facts();
  EXPECT_FALSE(facts.version.empty());
  EXPECT_FALSE(facts.type.empty());
  EXPECT_TRUE(facts.compiler.starts_with("GCC ") || facts.compiler.starts_with("Clang "));
  EXPECT_FALSE(facts.revision.has_value()) << "tests do not call psygen_revision()";
  EXPECT_FALSE(facts.clean.has_value());
}

}  // namespace
}  // namespace psygen::telemetry
