// Finds data files of psygen or of a program (worlds, paths, images), independent of the folder of
// installation, build or start; and the folders of a user that keep a program's data and settings.
// Also the version of psygen. It opens no file. Any thread, if no thread changes the environment at
// the same time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"

// The data folder of the psygen that a program was built with. The package and add_subdirectory()
// define it for programs that link psygen::core.
#ifndef PSYGEN_DATA_FOLDER
#define PSYGEN_DATA_FOLDER ""
#endif

namespace psygen::core {

// The folders that data_file() searches, in this order; they need not exist:
//   1. `given`, if it is not empty;
//   2. those of the environment variable PSYGEN_DATA, separated by ':';
//   3. the folder of the executable, symbolic links resolved;
//   4. share/psygen of the executable's installation;
//   5. `built_with`, if it is not empty: share/psygen of the psygen that built the program.
std::vector<std::filesystem::path> data_folders(
    const std::filesystem::path& given = {},
    const std::filesystem::path& built_with = PSYGEN_DATA_FOLDER);

// The folders `name` ("worlds") in the folders 3 to 5, of an installation or a build.
std::vector<std::filesystem::path> installed_folders(
    const std::filesystem::path& name,
    const std::filesystem::path& built_with = PSYGEN_DATA_FOLDER);

// Returns the file `name` ("worlds/paper.toml") in the first folder that has it. Fails with
// kInvalidArgument if `name` is empty, absolute or has a "..". Fails with kIo and a message that
// lists all folders if no folder has a file of this name.
Result<std::filesystem::path> data_file(
    const std::filesystem::path& name, const std::filesystem::path& given = {},
    const std::filesystem::path& built_with = PSYGEN_DATA_FOLDER);

// Purpose of a user's folder. Data: $XDG_DATA_HOME or ~/.local/share. Configuration:
// $XDG_CONFIG_HOME or ~/.config. State (reports, logs): $XDG_STATE_HOME or ~/.local/state.
enum class UserFolder : std::uint8_t { kData, kConfig, kState };
// Returns the program's folder for this purpose, or `given` if it is not empty. It need not exist.
// Fails with kIo if neither the variable nor HOME is set.
Result<std::filesystem::path> user_folder_path(UserFolder folder, const std::string& program,
                                               const std::filesystem::path& given = {});
// Creates and returns user_folder_path(). Also fails with kIo if it cannot be created.
Result<std::filesystem::path> user_folder(UserFolder folder, const std::string& program,
                                          const std::filesystem::path& given = {});

// "MAJOR.MINOR.PATCH" of psygen, from project() in CMakeLists.txt: the version that --version, the
// package, ledgers and messages about other formats of files name.
std::string_view version();

}  // namespace psygen::core
