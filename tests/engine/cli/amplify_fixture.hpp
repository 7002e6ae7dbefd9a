// A folder with a small world in which psygen amplify synthesises regions.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/engine/cli/psygen_process.hpp"
#include "tests/engine/world/shipped.hpp"
#include "tests/full_disk.hpp"

namespace psygen::cli {

class AmplifyFixture : public testing::Test {
 protected:
  AmplifyFixture() { std::ofstream(folder_ / "small.toml") << world::testing::kSmallWorld; }

  // Runs `psygen amplify` in the folder, as one process.
  Outcome amplify(const std::string& arguments, const std::string& environment = "") const {
    return run_psygen("amplify --world small.toml " + arguments, environment, folder_.path());
  }
  // The hash in the output of --json.
  static std::string hash_in(const Outcome& outcome) {
    if (outcome.code != 0) return outcome.err;
    return nlohmann::json::parse(outcome.out)["hash"];
  }
  // The files of a subfolder, without ledgers.
  FileContents blocks_in(const std::string& folder) const {
    FileContents contents = contents_of(folder_ / folder);
    std::erase_if(contents, [](const auto& file) { return file.first.ends_with(".ledger"); });
    return contents;
  }

  const TemporaryFolder folder_;
};

}  // namespace psygen::cli
