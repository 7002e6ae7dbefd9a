// Screens a text before it is parsed as JSON: requests are small and flat; other texts could take
// any amount of memory and time. Pure; any thread.
#pragma once

#include <string_view>

namespace psygen::inspect {

// Returns true if a text has at most 64 brackets, commas and colons outside strings, nested at most
// 4 deep. Linear in the text.
bool is_small_json(std::string_view text);

}  // namespace psygen::inspect
