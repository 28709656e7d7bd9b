// SPDX-License-Identifier: BSD-3-Clause
// contact.h, material.h
#include <limits>

#include "chapters.h"

static nt_contact contact_of(double radius, double effective_modulus, double work_of_adhesion, double cohesive_stress)
{
    return {radius, effective_modulus, work_of_adhesion, cohesive_stress};
}

static nt_contact_law law_of(int model, const nt_contact &contact)
{
    nt_contact_law law;
    nt_problem problem{};
    raise_on(nt_contact_check(&contact, &problem), problem, "contact");
    raise_on(nt_contact_law_init(&law, static_cast<nt_model>(model), &contact), "contact");
    return law;
}

static py::tuple eval(const nt_contact_law &law, const Array &indentation, int branch)
{
    return map_law(indentation, [&law, branch](double delta) {
        constexpr double nan = std::numeric_limits<double>::quiet_NaN();
        nt_law_value value{nan, nan, nan, nan};
        (void)nt_contact_law_eval(&law, delta, static_cast<nt_branch>(branch), &value); // no solution there: NaN
        return value;
    });
}

static double indentation_at(const nt_contact_law &law, double force, int branch)
{
    const nt_contact *contact = &law.maugis.contact;
    double delta = std::numeric_limits<double>::quiet_NaN();
    switch (law.model) {
    case NT_HERTZ:
        return nt_hertz_indentation(contact, force);
    case NT_DMT:
        return nt_dmt_indentation(contact, force);
    case NT_JKR:
        (void)nt_jkr_indentation(contact, force, static_cast<nt_branch>(branch), &delta);
        break;
    case NT_MAUGIS:
        (void)nt_maugis_indentation(&law.maugis, force, static_cast<nt_branch>(branch), &delta, nullptr);
        break;
    }
    return delta; // untouched, so NaN, on failure
}

void bind_contact(py::module_ &module)
{
    py::class_<nt_contact_law>(module, "ContactLaw")
        .def(py::init([](int model, double radius, double modulus, double adhesion, double stress) {
                 return law_of(model, contact_of(radius, modulus, adhesion, stress));
             }),
             py::arg("model"), py::arg("radius"), py::arg("effective_modulus"), py::arg("work_of_adhesion"),
             py::arg("cohesive_stress"))
        .def("eval", &eval, py::arg("indentation"), py::arg("branch"))
        .def("indentation",
             [](const nt_contact_law &law, const Array &force, int branch) {
                 py::array_t<double> out(std::vector<py::ssize_t>(force.shape(), force.shape() + force.ndim()));
                 const double *in = force.data();
                 double *delta = out.mutable_data();
                 const py::ssize_t count = force.size();
                 {
                     py::gil_scoped_release release;
                     for (py::ssize_t i = 0; i < count; ++i)
                         delta[i] = indentation_at(law, in[i], branch);
                 }
                 return out;
             })
        .def_property_readonly("pull_off_force",
                               [](const nt_contact_law &l) { return nt_contact_law_pull_off_force(&l); })
        .def_property_readonly("grip_indentation",
                               [](const nt_contact_law &l) { return nt_contact_law_grip_indentation(&l); })
        .def_property_readonly("maugis_lambda",
                               [](const nt_contact_law &l) { return nt_maugis_lambda(&l.maugis.contact); });
    module.def("effective_modulus",
               [](double tip_modulus, double tip_ratio, double sample_modulus, double sample_ratio) {
                   return nt_effective_modulus({tip_modulus, tip_ratio}, {sample_modulus, sample_ratio});
               });
    module.def("cohesive_stress_atomic", &nt_cohesive_stress_atomic);
    module.def("cone_eval", [](double modulus, double half_angle, const Array &indentation) {
        return map_law(indentation, [=](double delta) { return nt_cone_eval(modulus, half_angle, delta); });
    });
    module.def("punch_eval", [](double modulus, double radius, const Array &indentation) {
        return map_law(indentation, [=](double delta) { return nt_punch_eval(modulus, radius, delta); });
    });
}
