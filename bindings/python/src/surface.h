// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
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

// What a surface is made of at each place, and the arrays that hold it.
struct Properties {
    std::array<Array, 2> values; // modulus, work of adhesion; either may be empty
    nt_properties properties;
};

// A terrain, and the surface, radii and properties that it borrows; each may be missing.
struct Terrain {
    std::shared_ptr<Surface> surface;
    std::shared_ptr<RadiusMap> radii;
    std::shared_ptr<Properties> properties;
    std::shared_ptr<nt_terrain> made;
};
