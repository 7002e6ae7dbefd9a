// A folder for the files of one test, on the disk under testing::TempDir(). One thread.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <iterator>
#include <string>
#include <system_error>

namespace psygen {

// An empty folder that belongs to the running test and is removed when the object ends.
class TemporaryFolder {
 public:
  // Creates the folder. Only inside a running test.
  TemporaryFolder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    // Another build may run the same test at the same time.
    path_ = std::filesystem::path(testing::TempDir()) /
            ("psygen_" + std::string(test->test_suite_name()) + "_" + test->name() + "_" +
             std::to_string(getpid()));
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  // Removes the folder and everything in it.
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  // The path of a file in the folder, and of the folder itself.
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }
  // Number of files and folders directly in it.
  std::size_t file_count() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path_), {}));
  }

 private:
  std::filesystem::path path_;
};

}  // namespace psygen
