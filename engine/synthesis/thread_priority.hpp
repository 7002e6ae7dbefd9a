// The two things that modelers ask of the operating system. Best effort: on systems without
// per-thread priorities nothing happens.
#pragma once

#include <string>

namespace psygen::synthesis {

// Nice 19 for the calling thread alone (Linux): it gets the processor time that no other thread
// wants.
void lower_priority_of_this_thread();
// At most 15 characters are kept.
void name_this_thread(const std::string& name);

}  // namespace psygen::synthesis
