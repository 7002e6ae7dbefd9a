// The rounding mode of a thread. World data have the same bits everywhere only if every operation
// rounds to nearest and keeps denormal numbers. Programs that use psygen may have other modes, and
// threads inherit them. So modelers and functions that compute world data begin with a
// RoundToNearest. Costs some nanoseconds. Any thread.
#pragma once

namespace psygen::core {

// While it lives, this thread rounds to nearest and flushes no denormal number to zero. Then the
// former mode returns. Nests.
class RoundToNearest {
 public:
  RoundToNearest();
  ~RoundToNearest();
  RoundToNearest(const RoundToNearest&) = delete;
  RoundToNearest& operator=(const RoundToNearest&) = delete;

 private:
  unsigned control_;  // former bits of the control register; 0: as wanted
  int mode_ = 0;      // former std::fegetround(), unless control_ is 0
};

}  // namespace psygen::core
