// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <vector>

#include "chapters.h"

// A surface that owns its coefficients.
struct Surface {
    std::vector<double> coefficients;
    nt_surface surface;
};
