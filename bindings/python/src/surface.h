// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>

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

// A terrain, and the surface and radii that it borrows; both may be missing.
struct Terrain {
    std::shared_ptr<Surface> surface;
    std::shared_ptr<RadiusMap> radii;
    std::shared_ptr<nt_terrain> made;
};
