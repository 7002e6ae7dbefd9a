#include "engine/core/rounding.hpp"

#include <cfenv>
#include <cstdint>

#ifdef __SSE__
#include <xmmintrin.h>
#endif

namespace psygen::core {
namespace {

// The control bits of this thread's arithmetic; 0: nearest, and no flush to zero.
#ifdef __SSE__
constexpr unsigned kControl = _MM_ROUND_MASK | _MM_FLUSH_ZERO_MASK | 0x0040;  // denormals are zero

unsigned control() {
  return _mm_getcsr() & kControl;
}
void set_control(unsigned bits) {
  _mm_setcsr((_mm_getcsr() & ~kControl) | bits);
}
#elif defined(__aarch64__)
constexpr std::uint64_t kControl = 3U << 22 | 1U << 24;  // of FPCR: rounding mode, flush to zero

std::uint64_t fpcr() {
  std::uint64_t bits = 0;
  asm volatile("mrs %0, fpcr" : "=r"(bits));
  return bits;
}
unsigned control() {
  return static_cast<unsigned>(fpcr() & kControl);
}
void set_control(unsigned bits) {
  asm volatile("msr fpcr, %0" : : "r"((fpcr() & ~kControl) | bits));
}
#else
unsigned control() {
  return std::fegetround() == FE_TONEAREST ? 0 : 1;
}
void set_control(unsigned) {}
#endif

}  // namespace

// std::fesetround() also sets the mode of the x87 unit, which functions such as std::strtod() obey.
RoundToNearest::RoundToNearest() : control_(control()) {
  if (control_ == 0) return;
  mode_ = std::fegetround();
  std::fesetround(FE_TONEAREST);
  set_control(0);
}

RoundToNearest::~RoundToNearest() {
  if (control_ == 0) return;
  std::fesetround(mode_);
  set_control(control_);
}

}  // namespace psygen::core
