// psygen doctor, as users run it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/engine/cli/psygen_process.hpp"

namespace psygen::cli {
namespace {

using testing::Contains;
using testing::HasSubstr;

TEST(Doctor, DescribesAMachineThatDraws) {
  const Outcome outcome = run_psygen("doctor --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json told = nlohmann::json::parse(outcome.out, nullptr, false);
  ASSERT_FALSE(told.is_discarded()) << outcome.out;
  EXPECT_EQ(told["schema"], "psygen.doctor/1");
  EXPECT_EQ(told["draws"], true);
  EXPECT_NE(told["device"]["name"], "");
  EXPECT_NE(told["device"]["driver"], "");
  EXPECT_EQ(told["device"]["preset"], told["device"]["type"] == "software" ? "low" : "high");
  EXPECT_GE(told["threads"]["usable"], 1);
  EXPECT_GE(told["memory"]["total_bytes"], 1 << 20);
  EXPECT_THAT(
      told["folders"]["data"],
      Contains(testing::ResultOf([](const nlohmann::json& f) { return f["worlds"]; }, true)));
  for (const char* library : {"fmt", "glfw3", "hwy", "imgui", "Vulkan"})
    EXPECT_NE(told["libraries"][library].value("compiled", ""), "") << library;
  for (const char* library : {"glfw3", "Vulkan", "OpenImageIO", "C library"})
    EXPECT_THAT(told["libraries"][library].value("loaded", ""), testing::ContainsRegex("[0-9]\\."))
        << library;
}

TEST(Doctor, PrintsTheSameForPeople) {
  const Outcome outcome = run_psygen("doctor", "PSYGEN_DATA=\"$(printf '/a\\033b')\"");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* section :
       {"program\n  version: ", "\nsystem\n  name: ", "\nthreads\n  processors: ",
        "\nmemory\n  total: ", "\ndevice\n  name: ", "\nfolders\n  data: path /a\\x1bb, ",
        "\nlibraries\n", "\nenvironment\n", "\nslow\n"})
    EXPECT_THAT(outcome.out, HasSubstr(section));
}

TEST(Doctor, WithoutADeviceDescribesTheRest) {
  const Outcome outcome =
      run_psygen("doctor --json", "VK_DRIVER_FILES=/none VK_ICD_FILENAMES=/none");
  EXPECT_EQ(outcome.code, 4);
  EXPECT_THAT(outcome.err, HasSubstr("psygen: error: "));
  const nlohmann::json told = nlohmann::json::parse(outcome.out, nullptr, false);
  ASSERT_FALSE(told.is_discarded()) << outcome.out;
  EXPECT_EQ(told["draws"], false);
  EXPECT_NE(told["device"].value("error", ""), "");
  EXPECT_GE(told["threads"]["modelers"], 1);
  EXPECT_EQ(told["environment"]["VK_DRIVER_FILES"], "/none");
}

TEST(Doctor, NamesWhatMakesPsygenSlow) {
  const Outcome outcome = run_psygen(
      "doctor --json", "unset LP_NUM_THREADS; taskset -c " + std::to_string(sched_getcpu()));
  const nlohmann::json told = nlohmann::json::parse(outcome.out, nullptr, false);
  ASSERT_FALSE(told.is_discarded()) << outcome.err;
  EXPECT_EQ(told["threads"]["allowed_by_affinity"], 1);
  EXPECT_EQ(told["threads"]["usable"], 1);
  EXPECT_EQ(told["threads"]["modelers"], 1);
  EXPECT_EQ(told["threads"]["rasteriser_threads_if_software"], 0);
  EXPECT_THAT(told["slow"], Contains("one processor is usable: frames and modelers share it"));
}

TEST(Doctor, NamesFoldersThatCannotBeWritten) {
  const Outcome outcome =
      run_psygen("doctor --json", "unset XDG_DATA_HOME XDG_STATE_HOME; export HOME=/dev/null;");
  const nlohmann::json told = nlohmann::json::parse(outcome.out, nullptr, false);
  ASSERT_FALSE(told.is_discarded()) << outcome.err;
  EXPECT_EQ(told["folders"]["user_data"]["path"], "/dev/null/.local/share/psygen");
  EXPECT_EQ(told["folders"]["user_data"]["exists"], false);
  EXPECT_EQ(told["folders"]["user_data"]["writable"], false);
  EXPECT_EQ(told["folders"]["temporary"]["writable"], true);
}

}  // namespace
}  // namespace psygen::cli
