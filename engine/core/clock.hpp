// Time. Seconds as doubles from a monotonic clock; CPU time of the calling thread.
#pragma once

namespace psygen::core {

double monotonic_seconds();
double thread_cpu_seconds();

}  // namespace psygen::core
