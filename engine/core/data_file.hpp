// Finds the files that come with a program or with psygen (worlds, paths, pictures), wherever the
// program is installed or built and from whatever folder it is run. It opens nothing. Any thread,
// as long as nobody changes the environment meanwhile.
#pragma once

#include <filesystem>
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

}  // namespace psygen::core
