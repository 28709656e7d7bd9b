// SPDX-License-Identifier: BSD-3-Clause
// The contents page of the extension: one chapter per public header.
#include "chapters.h"
#include "nanotouch/version.h"

void bind_contact_ufunc(py::module_ &module);
void bind_host(py::module_ &module);

PYBIND11_MODULE(_core, module)
{
    module.doc() = "The C library of nanotouch. Use the Python modules of the package; this one has no promises.";
    module.attr("version") = nt_version();
    bind_contact(module);
    bind_contact_reduced(module);
    bind_contact_ufunc(module);
    bind_maugis_bank(module);
    bind_forces(module);
    bind_friction(module);
    bind_geometry(module);
    bind_materials(module);
    bind_surface(module);
    bind_descriptions(module);
    bind_margins(module);
    bind_particle(module);
    bind_rod(module);
    bind_pushed(module);
    bind_plasticity(module);
    bind_rheology(module);
    bind_plan(module);
    bind_c_header(module);
    bind_terrain(module);
    bind_interaction(module);
    bind_scan(module);
    bind_steady(module);
    bind_tapping(module);
    bind_view(module);
    bind_curves(module);
    bind_control(module);
    bind_faults(module);
    bind_hal(module);
    bind_session(module);
    bind_frames(module);
    bind_commands(module);
    bind_host(module);
#ifdef NANOTOUCH_HAS_LINUX
    bind_linux(module);
#endif
}
