#include "engine/render/device/software_tuning.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mman.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <thread>

namespace psygen::render {
namespace {

// The kernel's flags of the mapping that holds an address.
std::string mapping_flags(const void* address) {
  const auto wanted = reinterpret_cast<std::uintptr_t>(address);
  std::ifstream maps("/proc/self/smaps");
  bool inside = false;
  for (std::string line; std::getline(maps, line);) {
    std::uintptr_t first = 0, end = 0;
    char dash = 0;
    std::istringstream text(line);
    if (text >> std::hex >> first >> dash >> end && dash == '-')
      inside = first <= wanted && wanted < end;
    if (inside && line.starts_with("VmFlags:")) return line + " ";
  }
  return {};
}

TEST(SoftwareTuning, FreshMemoryIsMadeOfHugePagesWhereTheKernelHasThem) {
  constexpr std::size_t kBytes = 16u << 20;
  void* const memory =
      mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  const std::span<std::byte> bytes(static_cast<std::byte*>(memory), kBytes);
  prefer_huge_pages(bytes);
  const bool kernel_has_them = std::filesystem::exists("/sys/kernel/mm/transparent_hugepage");
  const bool asked_for = mapping_flags(&bytes[kBytes / 2]).find(" hg ") != std::string::npos;
  EXPECT_EQ(asked_for, kernel_has_them);
  EXPECT_EQ(munmap(memory, kBytes), 0);
}

TEST(SoftwareTuning, MemoryOfAnySizeAndAlignmentKeepsItsContent) {
  const auto memory = std::make_unique<std::byte[]>(6u << 20);
  for (const auto& [first, size] : {std::pair(0u, 0u), {1u, 4095u}, {17u, 5u << 20}}) {
    const std::span<std::byte> bytes(memory.get() + first, size);
    std::ranges::fill(bytes, std::byte{0x5A});
    prefer_huge_pages(bytes);
    EXPECT_EQ(std::ranges::count(bytes, std::byte{0x5A}), static_cast<std::ptrdiff_t>(size));
  }
}

// fit_software_rendering() on one of the processors, and the variable that it leaves.
std::pair<std::optional<std::size_t>, std::string> fit_on_one_processor() {
  std::pair<std::optional<std::size_t>, std::string> found;
  std::thread([&found] {  // the affinity of a thread ends with it
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<std::size_t>(sched_getcpu()), &set);
    if (sched_setaffinity(0, sizeof(set), &set) != 0) return;
    if (const auto threads = fit_software_rendering()) found.first = *threads;
    if (const char* variable = std::getenv("LP_NUM_THREADS")) found.second = variable;
  })
      .join();
  return found;
}

TEST(SoftwareTuning, DrawsWithTheProcessorsOfTheAffinityUnlessTheUserSaysMore) {
  const char* const variable = std::getenv("LP_NUM_THREADS");
  const std::optional<std::string> before =
      variable != nullptr ? std::optional<std::string>(variable) : std::nullopt;
  unsetenv("LP_NUM_THREADS");
  EXPECT_EQ(fit_on_one_processor(), (std::pair<std::optional<std::size_t>, std::string>(0, "0")));
  setenv("LP_NUM_THREADS", "3", 1);
  EXPECT_EQ(fit_on_one_processor(), (std::pair<std::optional<std::size_t>, std::string>(3, "3")));
  unsetenv("LP_NUM_THREADS");
  if (before) setenv("LP_NUM_THREADS", before->c_str(), 1);
}

}  // namespace
}  // namespace psygen::render
