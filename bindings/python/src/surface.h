// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "chapters.h"

// A surface and the array that holds its coefficients.
struct Surface {
    Array coefficients;
    nt_surface surface;
};

// The effective radius over a surface, and the array that holds its coefficients.
struct RadiusMap {
    Array coefficients;
    nt_radius_map map;
};
