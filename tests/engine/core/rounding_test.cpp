#include "engine/core/rounding.hpp"

#include <gtest/gtest.h>

#include <cfenv>
#include <cstdint>
#ifdef __SSE__
#include <xmmintrin.h>
#endif

namespace psygen::core {
namespace {

// Divides at run time.
double third() {
  volatile double one = 1, three = 3;
  return one / three;
}

TEST(RoundToNearest, HoldsWhileItLivesAndRestoresTheFormerMode) {
  const double nearest = third();
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO, FE_TONEAREST}) {
    ASSERT_EQ(std::fesetround(mode), 0);
    const double outside = third();
    {
      const RoundToNearest rounding;
      const RoundToNearest nested;
      EXPECT_EQ(std::fegetround(), FE_TONEAREST);
      EXPECT_EQ(third(), nearest);
    }
    EXPECT_EQ(std::fegetround(), mode);
    EXPECT_EQ(third(), outside);
  }
  std::fesetround(FE_TONEAREST);
}

// The control register of vector units: its bits, those of rounding up and flushing denormals, and
// its flags, which arithmetic sets.
#if defined(__SSE__)
#define PSYGEN_CONTROL_REGISTER
constexpr std::uint64_t kUpAndFlush = _MM_ROUND_UP | _MM_FLUSH_ZERO_ON | 0x0040, kFlags = 0x3F;
std::uint64_t control_register() {
  return _mm_getcsr();
}
void set_control_register(std::uint64_t bits) {
  _mm_setcsr(static_cast<unsigned>(bits));
}
#elif defined(__aarch64__)
#define PSYGEN_CONTROL_REGISTER
constexpr std::uint64_t kUpAndFlush = 1U << 22 | 1U << 24, kFlags = 0;
std::uint64_t control_register() {
  std::uint64_t bits = 0;
  asm volatile("mrs %0, fpcr" : "=r"(bits));
  return bits;
}
void set_control_register(std::uint64_t bits) {
  asm volatile("msr fpcr, %0" : : "r"(bits));
}
#endif

#ifdef PSYGEN_CONTROL_REGISTER
TEST(RoundToNearest, AlsoHoldsForModesOfVectorUnitsAlone) {
  const std::uint64_t before = control_register();
  const std::uint64_t changed = before | kUpAndFlush;
  const double nearest = third();
  set_control_register(changed);
  {
    const RoundToNearest rounding;
    EXPECT_EQ(third(), nearest);
    volatile float least = 1e-38F, half = 0.1F;
    EXPECT_GT(least * half, 0.0F) << "denormals stay";
  }
  EXPECT_EQ(control_register() & ~kFlags, changed & ~kFlags);
  set_control_register(before);
}
#endif

}  // namespace
}  // namespace psygen::core
