// direction.cl: sine and cosine of a direction, and rounding down, in plain arithmetic.
//
// The built-in functions differ between drivers in the last bits and are slow on some (PoCL emulates floor lane by
// lane). Since discrete decisions depend on these values, all devices must compute the same. List this file before the
// files that use it.

// Sine and cosine of x radians, |x| < 1000: reduction by multiples of pi/2 in three parts, then the Taylor polynomials
// of degree 9 and 10, whose remainders on [-pi/4, pi/4] are 2e-9 and 2e-10. Error at most 1e-7.
static inline float sine_cosine(const float x, float* cosine) {
  const float turns = x * 0.636619772f;
  const int quarter = (int)(turns + (turns < 0.0f ? -0.5f : 0.5f));
  const float n = (float)quarter;
  const float r = ((x - n * 1.5703125f) - n * 4.83751297e-4f) - n * 7.54979013e-8f;
  const float q = r * r;
  const float s = r + r * q * (-1.66666667e-1f + q * (8.33333333e-3f + q * (-1.98412698e-4f + q * 2.75573192e-6f)));
  const float c =
      1.0f - q * (0.5f - q * (4.16666667e-2f - q * (1.38888889e-3f - q * (2.48015873e-5f - q * 2.75573192e-7f))));
  const bool odd = (quarter & 1) != 0;
  const float sine = odd ? c : s, other = odd ? s : c;
  *cosine = ((quarter + 1) & 2) != 0 ? -other : other;
  return (quarter & 2) != 0 ? -sine : sine;
}

// Largest whole number not above x, |x| < 2^31.
static inline int whole_below(const float x) {
  const int t = (int)x;
  return x < (float)t ? t - 1 : t;
}
static inline int8 whole_below8(const float8 x) {
  const int8 t = convert_int8(x);
  return t + (x < convert_float8(t));
}
