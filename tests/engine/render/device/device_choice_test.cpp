#include "engine/render/device/device_choice.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace psygen::render {
namespace {

DeviceInfo device(std::string name, DeviceType type, std::string uuid,
                  std::vector<std::string> missing = {}) {
  DeviceInfo made;
  made.name = std::move(name);
  made.uuid = std::move(uuid);
  made.type = type;
  made.missing = std::move(missing);
  return made;
}

// A machine with a laptop's two GPUs, one of them old, and two software drivers.
const std::vector<DeviceInfo> kDevices{
    device("llvmpipe (LLVM 15.0.6, 256 bits)", DeviceType::kSoftware,
           "6d657361-3232-2e33-2e36-2d3100000000"),
    device("NVIDIA T4", DeviceType::kDiscrete, "aa000000-0000-0000-0000-000000000001",
           {"Vulkan 1.3: it has 1.1.0", "dynamicRendering"}),
    device("Intel(R) UHD Graphics 620", DeviceType::kIntegrated,
           "bb000000-0000-0000-0000-000000000002"),
    device("SwiftShader Device (LLVM 10.0.0)", DeviceType::kSoftware,
           "cc000000-0000-0000-0000-000000000003")};

std::string error_for(std::string_view wish, const std::vector<DeviceInfo>& devices = kDevices) {
  const auto chosen = choose_device(devices, wish);
  if (chosen) return "chose " + std::to_string(*chosen);
  EXPECT_EQ(chosen.error().code, core::ErrorCode::kNoDevice);
  return chosen.error().message;
}

TEST(DeviceChoice, TakesTheUsableDeviceOfTheBestTypeByDefault) {
  EXPECT_EQ(choose_device(kDevices, "").value(), 2u);
  const std::vector<DeviceInfo> alike{kDevices[0], kDevices[3]};
  EXPECT_EQ(choose_device(alike, "").value(), 0u) << "the first of two";
}

TEST(DeviceChoice, TakesAWholeNumberForAnIndexAndNeverForAPartOfAName) {
  EXPECT_EQ(choose_device(kDevices, "0").value(), 0u);
  EXPECT_EQ(choose_device(kDevices, "3").value(), 3u);
  for (const std::string wish : {"15", "620", "99999999999999999999999"}) {
    EXPECT_TRUE(error_for(wish).starts_with("no Vulkan device has the index, UUID or name '" +
                                            wish + "'; there is 0 'llvmpipe (LLVM"))
        << error_for(wish);
  }
}

TEST(DeviceChoice, TakesAUuidOrAPartOfANameInAnyCase) {
  EXPECT_EQ(choose_device(kDevices, "CC000000-0000-0000-0000-000000000003").value(), 3u);
  EXPECT_EQ(choose_device(kDevices, "swiftshader").value(), 3u);
  EXPECT_EQ(choose_device(kDevices, "LLVM 15").value(), 0u);
  EXPECT_EQ(choose_device(kDevices, "UHD").value(), 2u);
  EXPECT_TRUE(error_for("cc000000").starts_with("no Vulkan device")) << "a part of a UUID";
}

TEST(DeviceChoice, RefusesANameThatFitsSeveralAndListsOnlyThose) {
  EXPECT_EQ(error_for("LLVM"),
            "'LLVM' fits several Vulkan devices: 0 'llvmpipe (LLVM 15.0.6, 256 bits)', 3 "
            "'SwiftShader Device (LLVM 10.0.0)'; give an index or a UUID");
  const std::vector<DeviceInfo> twins(2, kDevices[0]);
  EXPECT_NE(error_for(twins[0].name, twins).find("fits several"), std::string::npos);
  EXPECT_NE(error_for(twins[0].uuid, twins).find("fits several"), std::string::npos);
  EXPECT_EQ(choose_device(twins, "1").value(), 1u);
}

TEST(DeviceChoice, PrefersAWholeNameToAPartOfAnother) {
  const std::vector<DeviceInfo> devices{device("NVIDIA T4G", DeviceType::kDiscrete, "1"),
                                        device("NVIDIA T4", DeviceType::kDiscrete, "2")};
  EXPECT_EQ(choose_device(devices, "nvidia t4").value(), 1u);
  EXPECT_NE(error_for("NVIDIA", devices).find("fits several"), std::string::npos);
}

TEST(DeviceChoice, TellsOfEachDeviceEverythingThatItLacks) {
  EXPECT_EQ(error_for("T4"),
            "psygen cannot use the Vulkan device 1 'NVIDIA T4' (lacks Vulkan 1.3: it has 1.1.0, "
            "dynamicRendering)");
  EXPECT_EQ(error_for("", {kDevices[1]}),
            "psygen can use no Vulkan device of this machine: 0 'NVIDIA T4' (lacks Vulkan 1.3: it "
            "has 1.1.0, dynamicRendering)");
  EXPECT_NE(error_for("Radeon").find("1 'NVIDIA T4' (lacks Vulkan 1.3"), std::string::npos);
  EXPECT_EQ(error_for("", {}), "there is no Vulkan device on this machine");
}

TEST(DeviceChoice, GivesSoftwareTheCpuPathAndTheLowPreset) {
  DeviceInfo able = kDevices[0];
  able.gpu_path = true;
  EXPECT_EQ(default_path(able), RenderPath::kCpu);
  EXPECT_EQ(default_preset(able), Preset::kLow);
  able.type = DeviceType::kDiscrete;
  EXPECT_EQ(default_path(able), RenderPath::kGpu);
  EXPECT_EQ(default_preset(able), Preset::kHigh);
  able.gpu_path = false;
  EXPECT_EQ(default_path(able), RenderPath::kCpu);
}

}  // namespace
}  // namespace psygen::render
