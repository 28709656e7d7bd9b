// SPDX-License-Identifier: BSD-3-Clause
// forces.h
#include "chapters.h"

void bind_forces(py::module_ &module) {
    module.def("vdw_eval", [](const Array &gap, double radius, double hamaker, double roughness, double minimum_gap) {
        const nt_vdw vdw = {radius, hamaker, roughness, minimum_gap};
        nt_problem problem{};
        raise_on(nt_vdw_check(&vdw, &problem), problem, "van der Waals force");
        return map_law(gap, [&vdw](double h) { return nt_vdw_eval(&vdw, h); });
    });
    module.def("capillary_eval", [](const Array &gap, double radius, double tension, double meniscus, double film) {
        const nt_capillary capillary = {radius, tension, meniscus, film};
        nt_problem problem{};
        raise_on(nt_capillary_check(&capillary, &problem), problem, "capillary force");
        return map_law(gap, [&capillary](double h) { return nt_capillary_eval(&capillary, h); });
    });
    module.def("electrostatic_eval", [](const Array &gap, double radius, double potential, double minimum_gap) {
        const nt_electrostatic electrostatic = {radius, potential, minimum_gap};
        nt_problem problem{};
        raise_on(nt_electrostatic_check(&electrostatic, &problem), problem, "electrostatic force");
        return map_law(gap, [&electrostatic](double h) { return nt_electrostatic_eval(&electrostatic, h); });
    });
    module.def("kelvin_radius", &nt_kelvin_radius);
}
