// Which process has a file locked, as far as Linux tells (/proc/locks). For messages only: the
// answer may be out of date when it arrives. Any thread.
#pragma once

#include <filesystem>
#include <string>

namespace psygen::save {

// "process 123 (name)", "this program", or "another program" where the system does not tell.
std::string lock_holder(const std::filesystem::path& file);

}  // namespace psygen::save
