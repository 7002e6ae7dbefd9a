// The process that has locked a file, if Linux tells (/proc/locks). For messages only: the answer
// may be outdated on return. Any thread.
#pragma once

#include <filesystem>
#include <string>

namespace psygen::save {

// "process 123 (name)", "this program", or "another program" if the system does not tell.
std::string lock_holder(const std::filesystem::path& file);

}  // namespace psygen::save
