// Thread priority and thread name. Best effort: does nothing on systems without per-thread
// priorities.
#pragma once

#include <string>

namespace psygen::synthesis {

// Sets nice 19 for the calling thread alone (Linux): it uses processor time that no other thread
// needs.
void lower_priority_of_this_thread();
// Sets the name of the calling thread; at most 15 characters are kept.
void name_this_thread(const std::string& name);

}  // namespace psygen::synthesis
