/* SPDX-License-Identifier: BSD-3-Clause
 * Private: complex numbers and points of the unit circle. */
#ifndef NANOTOUCH_CORE_COMPLEX_NUMBER_H
#define NANOTOUCH_CORE_COMPLEX_NUMBER_H

#include <complex.h>
#include <math.h>

/* CMPLX of C11, which not every C library has; for finite parts. */
static inline double complex nt_complex(double re, double im)
{
    return re + im * (double complex)I;
}

/* The root whose real part is not negative: csqrt, which bare-metal C libraries lack. */
static inline double complex nt_complex_root(double complex z)
{
    const double re = creal(z), im = cimag(z), size = sqrt(0.5 * (fabs(re) + sqrt(re * re + im * im)));
    if (size == 0.0)
        return nt_complex(0.0, im);
    const double other = 0.5 * im / size;
    return re >= 0.0 ? nt_complex(size, other) : nt_complex(fabs(other), copysign(size, im));
}

/* exp(j theta) - 1, accurate where theta is small. */
static inline double complex nt_complex_from_one(double theta)
{
    const double half = sin(0.5 * theta);
    return nt_complex(-2.0 * half * half, sin(theta));
}

#endif
