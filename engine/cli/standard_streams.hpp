// The three streams that a program starts with, and writing data to the second. Main thread.
#pragma once

#include <string>

namespace psygen::cli {

// Takes the place of streams that are closed (`>&-`), so that no file that is opened later gets
// their numbers and with them what is meant for them. Writing to such a stdout fails, as it should.
void hold_standard_streams();

// Writes data to stdout. kFailed if it cannot be written, with a message unless the reader has
// closed the pipe.
int print(const std::string& text);

}  // namespace psygen::cli
