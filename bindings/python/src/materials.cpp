// SPDX-License-Identifier: BSD-3-Clause
// material.h: the table of materials
#include "chapters.h"

// (name, symbol, E, nu, surface energy, Hamaker constant, Y) of every material.
static py::list materials()
{
    py::list all;
    for (int i = 0; const nt_material_entry *entry = nt_material_at(i); ++i)
        all.append(py::make_tuple(entry->name, entry->symbol, entry->elastic.youngs_modulus,
                                  entry->elastic.poisson_ratio, entry->surface_energy, entry->hamaker_constant,
                                  entry->yield_strength));
    return all;
}

void bind_materials(py::module_ &module)
{
    module.def("materials", &materials);
    module.def("hamaker_combine", &nt_hamaker_combine);
    module.def("work_of_adhesion", &nt_work_of_adhesion);
}
