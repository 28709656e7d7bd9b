// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "chapters.h"

// A surface and the array that holds its coefficients.
struct Surface {
    Array coefficients;
    nt_surface surface;
};
