// SPDX-License-Identifier: BSD-3-Clause
// contact.h, material.h
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include "contact_table.h"
#include "internal/contact.h"
#include "internal/contact_equilibrium.h"
#include "internal/maugis.h"
#include "nanotouch/advanced/contact_equilibrium.h"

// A law made ready for one branch, and its table where the tier asks for one.
struct PreparedLaw {
    nt_contact_law law{};
    nt_branch branch;
    nt_tier tier;
    std::vector<nt_maugis_cell> cells;
    nt_maugis_table table{};

    PreparedLaw(int model, const nt_contact &contact, int on, int level)
        : branch(static_cast<nt_branch>(on)), tier(static_cast<nt_tier>(level))
    {
        nt_problem problem{};
        raise_on(nt_contact_check(&contact, &problem), problem, "contact");
        raise_on(nt_contact_law_init(&law, static_cast<nt_model>(model), &contact), "contact");
        if (needs_table(law.model, branch, tier))
            raise_on(make_table(law, cells, table), "contact");
    }

    // No solution there: NaN.
    nt_law_value values(double indentation) const
    {
        nt_law_value value{NAN, NAN, NAN, NAN};
        const nt_strided one = {&indentation, &value.U, &value.F, &value.k, &value.a, 1, 1, 1};
        (void)(cells.empty() ? nt_contact_law_eval(&law, indentation, branch, &value)
                             : nt_maugis_table_eval_n(&table, tier, branch, &one));
        return value;
    }
    double force(double indentation) const
    {
        double force = NAN;
        if (cells.empty())
            return values(indentation).F;
        (void)(tier == NT_TIER_TABLE ? nt_maugis_table_force_n : nt_maugis_table_polish_n)(&table, branch, &indentation,
                                                                                           &force, 1);
        return force;
    }
};

static double indentation_at(const PreparedLaw &self, double force)
{
    const nt_contact_law &law = self.law;
    const nt_contact *contact = &law.maugis.contact;
    double delta = std::numeric_limits<double>::quiet_NaN();
    switch (law.model) {
    case NT_HERTZ:
        return nt_hertz_indentation(contact, force);
    case NT_DMT:
        return nt_dmt_indentation(contact, force);
    case NT_JKR:
        (void)nt_jkr_indentation(contact, force, self.branch, &delta);
        break;
    case NT_MAUGIS:
        (void)nt_maugis_indentation(&law.maugis, force, self.branch, &delta, nullptr);
        break;
    }
    return delta; // untouched, so NaN, on failure
}

// What the curves of a batch have in common.
struct Batch {
    nt_model model;
    nt_branch branch;
    py::ssize_t first; // its number among all curves
    long points;
};

static nt_status one_ramp(const Batch &batch, const nt_contact &contact, double spring, const double *stage,
                          double *force)
{
    nt_contact_law law;
    const nt_status status = nt_contact_law_init(&law, batch.model, &contact);
    if (status != NT_OK)
        return status;
    const nt_ramp ramp = {spring, batch.branch, stage, force, batch.points};
    return nt_contact_law_ramp(&law, &ramp);
}

// Forces, shape (n, points), at stage indentations of that shape; of each curve a contact {R, E*, w, sigma0} and k_c.
static Array ramps(const std::tuple<int, int, py::ssize_t> &which, const Array &contacts, const Array &springs,
                   const Array &stage)
{
    if (contacts.ndim() != 2 || contacts.shape(1) != 4 || springs.ndim() != 1 || stage.ndim() != 2 ||
        contacts.shape(0) != stage.shape(0) || springs.shape(0) != stage.shape(0))
        throw py::value_error("ramps: contacts (n, 4), springs (n,) and stage (n, points) are expected");
    const Batch batch = {static_cast<nt_model>(std::get<0>(which)), static_cast<nt_branch>(std::get<1>(which)),
                         std::get<2>(which), static_cast<long>(stage.shape(1))};
    const py::ssize_t count = stage.shape(0);
    Array out({count, stage.shape(1)});
    const double *row = contacts.data(), *spring = springs.data(), *in = stage.data();
    double *force = out.mutable_data();
    nt_status status = NT_OK;
    py::ssize_t i = 0;
    {
        py::gil_scoped_release release;
        for (; i < count && status == NT_OK; ++i)
            status = one_ramp(batch, {row[4 * i], row[4 * i + 1], row[4 * i + 2], row[4 * i + 3]}, spring[i],
                              in + i * batch.points, force + i * batch.points);
    }
    if (status != NT_OK) {
        const double *at = row + 4 * (i - 1);
        const nt_contact contact = {at[0], at[1], at[2], at[3]};
        nt_problem problem{};
        const std::string what = "curve " + std::to_string(batch.first + i - 1);
        raise_on(nt_contact_check(&contact, &problem), problem, what);
        raise_on(status, what);
    }
    return out;
}

void bind_contact(py::module_ &module)
{
    module.def("ramps", &ramps);
    py::class_<PreparedLaw>(module, "ContactLaw")
        .def(py::init([](int model, double radius, double modulus, double adhesion, double stress, int branch,
                         int tier) { return PreparedLaw(model, {radius, modulus, adhesion, stress}, branch, tier); }),
             py::arg("model"), py::arg("radius"), py::arg("effective_modulus"), py::arg("work_of_adhesion"),
             py::arg("cohesive_stress"), py::arg("branch"), py::arg("tier"))
        .def("force", [](const PreparedLaw &self, double indentation) { return self.force(indentation); })
        .def("evaluate",
             [](const PreparedLaw &self, double indentation) {
                 const nt_law_value value = self.values(indentation);
                 return py::make_tuple(value.U, value.F, value.k, value.a);
             })
        .def("indentation",
             [](const PreparedLaw &self, const Array &force) {
                 py::array_t<double> out(std::vector<py::ssize_t>(force.shape(), force.shape() + force.ndim()));
                 const double *in = force.data();
                 double *delta = out.mutable_data();
                 const py::ssize_t count = force.size();
                 {
                     py::gil_scoped_release release;
                     for (py::ssize_t i = 0; i < count; ++i)
                         delta[i] = indentation_at(self, in[i]);
                 }
                 return out;
             })
        .def_property_readonly("pull_off_force",
                               [](const PreparedLaw &self) { return nt_contact_law_pull_off_force(&self.law); })
        .def_property_readonly("grip_indentation",
                               [](const PreparedLaw &self) { return nt_contact_law_grip_indentation(&self.law); })
        .def_property_readonly("maugis_lambda",
                               [](const PreparedLaw &self) { return nt_maugis_lambda(&self.law.maugis.contact); });
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
