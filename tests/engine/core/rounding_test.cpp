#include "engine/core/rounding.hpp"

#include <gtest/gtest.h>

#include <cfenv>
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

#ifdef __SSE__
TEST(RoundToNearest, AlsoHoldsForModesOfSseAlone) {
  const unsigned before = _mm_getcsr();
  const unsigned changed = before | _MM_ROUND_UP | _MM_FLUSH_ZERO_ON | 0x0040;
  const double nearest = third();
  _mm_setcsr(changed);
  {
    const RoundToNearest rounding;
    EXPECT_EQ(third(), nearest);
    volatile float least = 1e-38F, half = 0.1F;
    EXPECT_GT(least * half, 0.0F) << "denormals stay";
  }
  EXPECT_EQ(_mm_getcsr() & ~0x3FU, changed & ~0x3FU) << "but for the flags";
  _mm_setcsr(before);
}
#endif

}  // namespace
}  // namespace psygen::core
