// SPDX-License-Identifier: BSD-3-Clause
// plan.h, scene.h: the plan as data, and the interaction along a path of gaps
#include "descriptions.h"

static nt_plan plan_of(const Described<nt_scene> &scene, double accuracy, double floor, double load)
{
    const nt_demand demand = {accuracy, floor, load};
    nt_plan plan;
    nt_problem problem{};
    raise_on(nt_plan_make(&plan, &scene.value, &demand, nullptr, &problem), problem, "plan");
    return plan;
}

static py::dict as_dict(const nt_plan &plan)
{
    static const char *const sources[] = {"none", "solid", "meniscus"};
    py::list terms;
    for (const nt_plan_term &term : plan.terms)
        terms.append(py::make_tuple(term.name, term.included != 0, term.bound));
    const nt_contact &contact = plan.contact.maugis.contact;
    py::dict out;
    out["terms"] = terms;
    out["adhesion_source"] = sources[plan.source];
    out["lambda"] = plan.lambda;
    out["work_of_adhesion"] = contact.work_of_adhesion;
    out["cohesive_stress"] = contact.cohesive_stress;
    out["effective_modulus"] = contact.effective_modulus;
    out["radius"] = contact.radius;
    out["capture_gap"] = plan.capture_gap;
    out["release_gap"] = plan.release_gap;
    out["pull_off_force"] = plan.pull_off_force;
    out["maximum_stiffness"] = plan.maximum_stiffness;
    out["contact_strain"] = plan.contact_strain;
    return out;
}

void bind_plan(py::module_ &module)
{
    py::class_<nt_plan>(module, "Plan")
        .def(py::init(&plan_of), py::arg("scene"), py::arg("relative_accuracy"), py::arg("force_floor"),
             py::arg("maximum_load"))
        .def("as_dict", &as_dict)
        .def(
            "run",
            [](const nt_plan &plan, const Array &gap, bool attached) {
                nt_interaction_state state = {attached ? 1 : 0};
                return map_law(gap, [&plan, &state](double h) {
                    if (h == h)
                        nt_interaction_advance(&plan, &state, h); // a NaN is no step of the path
                    return nt_interaction_eval_gap(&plan, &state, h);
                });
            },
            py::arg("gap"), py::arg("attached") = false);
}
