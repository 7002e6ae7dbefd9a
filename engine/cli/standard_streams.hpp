// The three standard streams, and writing data to stdout. Main thread.
#pragma once

#include <string>

namespace psygen::cli {

// Reserves the descriptors of closed streams (`>&-`), so that a file opened later does not receive
// their output. Writing to such a stdout fails, as it should.
void reserve_standard_streams();

// Writes data to stdout. Returns kFailed if it cannot be written, with a message unless the reader
// has closed the pipe.
int print(const std::string& text);

}  // namespace psygen::cli
