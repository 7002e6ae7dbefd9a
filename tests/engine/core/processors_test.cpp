#include "engine/core/processors.hpp"

#include <gtest/gtest.h>
#include <sched.h>

#include <fstream>
#include <string>
#include <thread>

#include "tests/temporary_folder.hpp"

namespace psygen::core {
namespace {

// A folder that stands for "/".
struct Machine {
  explicit Machine(const std::string& groups) { write("proc/self/cgroup", groups); }

  void write(const std::string& file, const std::string& text) const {
    const std::filesystem::path path = root.path() / file;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text << '\n';
  }
  // Of version 1.
  void write_quota(const std::string& group, const std::string& quota) const {
    write("sys/fs/cgroup/" + group + "/cpu.cfs_quota_us", quota);
    write("sys/fs/cgroup/" + group + "/cpu.cfs_period_us", "100000");
  }
  std::optional<double> quota() const { return processor_quota(root.path()); }
  unsigned within(unsigned processors) const { return within_quota(processors, root.path()); }

  TemporaryFolder root;
};

TEST(Processors, AreThoseOfTheAffinity) {
  cpu_set_t all;
  ASSERT_EQ(sched_getaffinity(0, sizeof(all), &all), 0);
  EXPECT_EQ(allowed_processors(), static_cast<unsigned>(CPU_COUNT(&all)));
  int first = 0;
  while (!CPU_ISSET(first, &all))
    ++first;
  unsigned of_one = 0;
  std::thread([&] {  // the affinity of a thread ends with it
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(first, &one);
    if (sched_setaffinity(0, sizeof(one), &one) == 0) of_one = allowed_processors();
  })
      .join();
  EXPECT_EQ(of_one, 1U);
}

TEST(Processors, TheQuotaIsTheSmallestOfAllGroupsAroundTheProcess) {
  const Machine machine("0::/jobs/7");
  machine.write("sys/fs/cgroup/jobs/7/cpu.max", "max 100000");
  EXPECT_FALSE(machine.quota().has_value());
  machine.write("sys/fs/cgroup/jobs/cpu.max", "150000 100000");
  EXPECT_DOUBLE_EQ(*machine.quota(), 1.5);
  machine.write("sys/fs/cgroup/jobs/7/cpu.max", "250000 100000");
  EXPECT_DOUBLE_EQ(*machine.quota(), 1.5);
  machine.write("sys/fs/cgroup/jobs/7/cpu.max", "50000 100000");
  EXPECT_DOUBLE_EQ(*machine.quota(), 0.5);
}

TEST(Processors, TheQuotaOfAContainerIsAtTheRootOfItsGroups) {
  const Machine machine("0::/system.slice/container-1.scope");  // a name of the host
  machine.write("sys/fs/cgroup/cpu.max", "200000 100000");
  EXPECT_DOUBLE_EQ(*machine.quota(), 2);
}

TEST(Processors, QuotasOfVersion1AreThoseOfItsControllerOfProcessors) {
  const Machine machine("4:cpuset:/b\n3:cpuacct,cpu:/a\n2:memory:/b");
  machine.write_quota("cpuset/b", "100000");
  machine.write_quota("cpu/a", "-1");
  EXPECT_FALSE(machine.quota().has_value());
  machine.write_quota("cpu/a", "200000");
  EXPECT_DOUBLE_EQ(*machine.quota(), 2);
  machine.write_quota("cpuacct,cpu", "100000");
  EXPECT_DOUBLE_EQ(*machine.quota(), 1);
}

TEST(Processors, BothVersionsCountIfASystemHasBoth) {
  const Machine machine("3:cpu:/a\n0::/b");
  machine.write_quota("cpu/a", "300000");
  EXPECT_DOUBLE_EQ(*machine.quota(), 3);
  machine.write("sys/fs/cgroup/unified/b/cpu.max", "200000 100000");
  EXPECT_DOUBLE_EQ(*machine.quota(), 2);
}

TEST(Processors, AQuotaIsRoundedUpToWholeThreads) {
  const Machine machine("0::/");
  EXPECT_EQ(machine.within(16), 16U);
  for (const auto& [quota, threads] : {std::pair("50000", 1U),
                                       {"100000", 1U},
                                       {"150000", 2U},
                                       {"1000", 1U},
                                       {"1600000", 16U},
                                       {"9900000", 16U}}) {
    machine.write("sys/fs/cgroup/cpu.max", std::string(quota) + " 100000");
    EXPECT_EQ(machine.within(16), threads) << quota;
  }
  EXPECT_EQ(machine.within(0), 1U);
}

TEST(Processors, FilesWithoutAQuotaChangeNothing) {
  for (const char* text : {"", "max", "max 100000", "-1 100000", "0 100000", "50000", "50000 0",
                           "x 100000", "50000 x", "nan 1"}) {
    const Machine machine("0::/\nno colon\n1:\n:");
    machine.write("sys/fs/cgroup/cpu.max", text);
    EXPECT_FALSE(machine.quota().has_value()) << text;
    EXPECT_EQ(machine.within(4), 4U) << text;
  }
  EXPECT_FALSE(processor_quota(TemporaryFolder().path()).has_value());
}

}  // namespace
}  // namespace psygen::core
