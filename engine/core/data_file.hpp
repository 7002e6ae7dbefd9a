// Finds the files that come with a program or with psygen (worlds, paths, pictures), wherever the
// program is installed or built and from whatever folder it is run; and the folders of the user in
// which a program keeps what is its own. It opens no file. Any thread,
// as long as nobody changes the environment meanwhile.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/error.hpp"

// The data folder of the psygen that a program was built with. The package and add_subdirectory()
// define it for programs that link psygen::core.
#ifndef PSYGEN_DATA_FOLDER
#define PSYGEN_DATA_FOLDER ""
#endif

namespace psygen::core {

// The folders in which data_file() looks, in this order; they need not exist:
//   1. `given`, if it is not empty;
//   2. those of the environment variable PSYGEN_DATA, separated by ':';
//   3. the executable's own, symbolic links resolved;
//   4. share/psygen of the installation that the executable is in;
//   5. `built_with`, if it is not empty: share/psygen of the psygen it was built with.
std::vector<std::filesystem::path> data_folders(
    const std::filesystem::path& given = {},
    const std::filesystem::path& built_with = PSYGEN_DATA_FOLDER);

// The file `name` ("worlds/paper.toml") in the first of these folders that has it. Fails with
// kInvalidArgument if `name` is empty, absolute or has a "..", and with kIo and a sentence that
// lists all folders if there is no such file, also where it is a folder.
Result<std::filesystem::path> data_file(
    const std::filesystem::path& name, const std::filesystem::path& given = {},
    const std::filesystem::path& built_with = PSYGEN_DATA_FOLDER);

// What of a user a folder is for: $XDG_DATA_HOME or ~/.local/share, and $XDG_CONFIG_HOME or
// ~/.config.
enum class UserFolder : std::uint8_t { kData, kConfig };
// The folder of a program in it, or `given` if it is not empty; it is made. Fails with kIo where it
// cannot be made, and where neither variable nor HOME says where it is.
Result<std::filesystem::path> user_folder(UserFolder folder, const std::string& program,
                                          const std::filesystem::path& given = {});

}  // namespace psygen::core
