// Reports of crashes: a text with the program's revision, the machine, the stack and the last log
// lines, for a bug report. Not a core dump; the signal still makes one where the system wants it.
// The texts and folders are prepared at the start, because a handler of signals may call little.
// Private to engine/program. Linux.
#pragma once

#include <string_view>

namespace psygen::program {

// From now on SIGSEGV, SIGBUS, SIGFPE, SIGILL and SIGABRT write a report, tell its path on stderr,
// and end the program as they would without it. The report is a file in the user's folder for the
// state of `program`, else in the folder for temporary files, else it goes to stderr. Signals that
// have a handler already keep it. Builds with sanitizers keep theirs, so this does nothing there.
// Main thread, once, after core::set_log_name().
void report_crashes(std::string_view program);

// Adds a sentence to the report of a crash that follows, such as the message of an exception.
// Allocates nothing. At most 400 bytes are kept.
void note_cause_of_crash(std::string_view sentence);

}  // namespace psygen::program
