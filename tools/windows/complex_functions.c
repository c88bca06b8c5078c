// SPDX-License-Identifier: GPL-3.0-or-later
// Complex functions as Microsoft's C library has them: numbers are structures, which MinGW's own functions do not take.
#include <complex.h>

typedef union {
  struct Double {
    double parts[2];
  } parts;
  double _Complex number;
} Double;
typedef union {
  struct Float {
    float parts[2];
  } parts;
  float _Complex number;
} Float;

#define TO_REAL(name) \
  double own_##name(struct Double z) { return name(((Double){z}).number); } \
  float own_##name##f(struct Float z) { return name##f(((Float){z}).number); }
#define TO_COMPLEX(name) \
  struct Double own_##name(struct Double z) { return ((Double){.number = name(((Double){z}).number)}).parts; } \
  struct Float own_##name##f(struct Float z) { return ((Float){.number = name##f(((Float){z}).number)}).parts; }

TO_REAL(creal)
TO_REAL(cimag)
TO_REAL(cabs)
TO_REAL(carg)
TO_COMPLEX(cexp)
TO_COMPLEX(clog)
TO_COMPLEX(csqrt)
TO_COMPLEX(csin)
TO_COMPLEX(ccos)
TO_COMPLEX(ctan)
TO_COMPLEX(csinh)
TO_COMPLEX(ccosh)
TO_COMPLEX(ctanh)

struct Double own_cpow(struct Double z, struct Double power) {
  return ((Double){.number = cpow(((Double){z}).number, ((Double){power}).number)}).parts;
}
struct Float own_cpowf(struct Float z, struct Float power) {
  return ((Float){.number = cpowf(((Float){z}).number, ((Float){power}).number)}).parts;
}
