// Powers and sines whose bits depend on neither the C library nor the CPU: only additions,
// multiplications and divisions in double precision, each rounded separately. For constants of a
// model, such as amplitudes of octaves, not for kernels. Pure, about 20 steps a call. The relative
// error is below 1e-14 for results within 1e±30.
#pragma once

#include <array>
#include <cmath>

namespace psygen::models {

// Natural logarithm. Requires x > 0, finite.
inline double exact_log(double x) {
  int exponent = 0;
  double m = std::frexp(x, &exponent);  // [1/2, 1)
  if (m < 0.70710678118654752) {
    m *= 2;
    --exponent;
  }
  const double z = (m - 1) / (m + 1);  // |z| < 0.172: ln m = 2 artanh z
  double sum = 0;
  for (int k = 21; k >= 1; k -= 2)
    sum = sum * (z * z) + 1.0 / k;
  return 2 * z * sum + exponent * 0.69314718055994531;
}

// e^x. Requires |x| < 700.
inline double exact_exp(double x) {
  const double steps = std::floor(x * 1.4426950408889634 + 0.5);
  const double r = x - steps * 0.69314718055994531;  // |r| < 0.35
  double sum = 1;
  for (int k = 16; k >= 1; --k)
    sum = 1 + sum * r / k;
  return std::ldexp(sum, static_cast<int>(steps));
}

// base^exponent. Requires base > 0.
inline double exact_pow(double base, double exponent) {
  return exact_exp(exponent * exact_log(base));
}

// Sine and cosine of an angle in degrees. Errors are below 1e-15. The sine is exact at multiples of
// 180°, the cosine 90° away from them.
inline double exact_sin_degrees(double degrees) {
  double r = degrees - 360 * std::floor(degrees / 360 + 0.5);  // −180 … 180
  if (r > 90) r = 180 - r;
  if (r < -90) r = -180 - r;
  const double x = r * 0.017453292519943295, y = x * x;
  double sum = 1;
  for (int k = 24; k >= 2; k -= 2)
    sum = 1 - sum * y / (k * (k + 1));
  return x * sum;
}
inline double exact_cos_degrees(double degrees) {
  return exact_sin_degrees(degrees + 90);
}

// Linear light for each byte of sRGB.
inline const std::array<float, 256>& linear_light() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> t{};
    for (std::size_t i = 0; i < t.size(); ++i) {
      const double v = static_cast<double>(i) / 255;
      t[i] = static_cast<float>(v <= 0.04045 ? v / 12.92 : exact_pow((v + 0.055) / 1.055, 2.4));
    }
    return t;
  }();
  return table;
}

}  // namespace psygen::models
