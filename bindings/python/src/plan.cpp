// SPDX-License-Identifier: BSD-3-Clause
// plan.h: the plan as data
#include "chapters.h"
#include "words.h"

static py::tuple term_of(const nt_plan_term &term)
{
    return py::make_tuple(term.name, nt_form_name(term.form), term.force, term.bound, term.cost, term.title, term.words,
                          term.latency);
}

static py::list terms_of(const nt_plan &plan)
{
    py::list terms;
    for (const nt_plan_term &term : plan.terms) {
        if (term.name[0] == '\0') // a place for a law of one's own that has none
            continue;
        terms.append(term_of(term));
    }
    return terms;
}

static py::list warnings_of(const nt_plan &plan)
{
    py::list warnings;
    for (int i = 0; i < plan.warning_count; ++i) {
        const nt_plan_warning &warning = plan.warnings[i];
        warnings.append(py::make_tuple(warning.text, warning.unit, warning.value, warning.limit));
    }
    return warnings;
}

// {name: (least, largest)} of what the surface is made of
static py::dict properties_of(const nt_plan &plan)
{
    py::dict out;
    if (!plan.properties)
        return out;
    const nt_surface &modulus = plan.properties->youngs_modulus, &work = plan.properties->work_of_adhesion;
    if (modulus.coefficients)
        out["youngs_modulus"] = py::make_tuple(modulus.height_minimum, modulus.height_maximum);
    if (work.coefficients)
        out["work_of_adhesion"] = py::make_tuple(work.height_minimum, work.height_maximum);
    return out;
}

static void add_numbers(const nt_plan &plan, py::dict &out)
{
    out["bound"] = plan.bound.force_error;
    out["fold_shift"] = plan.bound.fold_shift;
    out["fold_distance"] = plan.fold_distance;
    out["model_error"] = plan.bound.model_error;
    out["cost"] = plan.cost;
    out["latency"] = plan.latency;
    out["full_cost"] = plan.full_cost;
    out["scale"] = plan.scale;
    out["elastic_number"] = plan.elastic_number;
    out["rigid_error"] = plan.rigid_error;
    out["around_error"] = plan.around_error;
    out["deforms"] = plan.deformation.count > 0;
    out["force_floor"] = plan.demand.force_floor;
    out["probe_noise"] = plan.probe_noise;
    out["lambda"] = plan.lambda;
    out["radius"] = plan.contact.radius;
    out["effective_modulus"] = plan.contact.effective_modulus;
    out["work_of_adhesion"] = plan.contact.work_of_adhesion;
    out["cohesive_stress"] = plan.contact.cohesive_stress;
    out["capture_gap"] = plan.capture_gap;
    out["release_gap"] = plan.release_gap;
    out["capture_energy"] = plan.capture_energy;
    out["release_energy"] = plan.release_energy;
    out["pull_off_force"] = plan.pull_off_force;
    out["largest_pull_off_force"] = plan.largest_pull_off_force;
    out["minimum_spring"] = plan.minimum_spring;
    out["maximum_stiffness"] = plan.maximum_stiffness;
    out["largest_indentation"] = plan.largest_indentation;
    out["length"] = plan.length;
    out["least_radius"] = plan.radii ? plan.radii->minimum : plan.contact.radius;
    out["largest_radius"] = plan.radii ? plan.radii->maximum : plan.contact.radius;
    out["curvature_error"] = plan.curvature_error;
    out["of_each_radius"] = plan.relief.count > 0; /* tables of a sample that deforms */
    out["properties"] = properties_of(plan);
}

static std::string quantity_of(const nt_demand &demand)
{
    const nt_field *field = nt_demand_fields(nullptr);
    while (std::string(field->name) != "demand.quantity")
        ++field;
    return word_of(field->unit, demand.quantity);
}

static py::dict as_dict(const nt_plan &plan)
{
    static const char *const sources[] = {"none", "solid", "meniscus"};
    py::dict out;
    out["terms"] = terms_of(plan);
    out["friction"] = term_of(plan.friction.term);
    out["adhesion_source"] = sources[plan.source];
    out["quantity"] = quantity_of(plan.demand);
    out["shape"] = nt_shape_name(plan.shape.kind);
    add_numbers(plan, out);
    out["rivals"] = py::dict(py::arg("hertz") = plan.rivals.hertz, py::arg("dmt") = plan.rivals.dmt,
                             py::arg("jkr") = plan.rivals.jkr);
    const nt_contact_validity &validity = plan.validity;
    out["validity"] =
        py::dict(py::arg("radius_ratio") = validity.radius_ratio, py::arg("slope") = validity.slope,
                 py::arg("strain") = validity.strain, py::arg("thickness_ratio") = validity.thickness_ratio);
    out["warnings"] = warnings_of(plan);
    const nt_plan_relaxation &of = plan.relaxation;
    out["relaxation"] =
        of.relaxes ? py::object(py::make_tuple(of.bed.springs, of.bed.arms, of.modulus, of.slow_modulus, of.error))
                   : py::object(py::none());
    return out;
}

// What the library says of each of its laws: name, title, what it is, the field of the scene that scales its part of w
// (or None), its forms with cost and words, whether it has a pressure.
static py::tuple term_rows()
{
    py::list rows;
    for (int term = 0; term < NT_PLAN_TERMS; ++term) {
        const nt_term_words &words = *nt_term_words_of(term);
        py::list forms;
        for (int i = 0; i < words.form_count; ++i)
            forms.append(py::make_tuple(nt_form_name(words.forms[i].form), words.forms[i].cost, words.forms[i].words,
                                        words.forms[i].latency));
        rows.append(
            py::make_tuple(words.name, words.title, words.doc, words.tail, py::tuple(forms), words.has_pressure != 0));
    }
    return py::tuple(rows);
}

// One law alone, in full; and two flats under it: {W, p, dp/dh}.
static py::tuple term_eval(const nt_plan &plan, int term, const Array &gaps)
{
    return map_law(gaps, [&plan, term](double gap) { return nt_plan_term_eval(&plan, term, gap); });
}

static py::tuple term_pressure(const nt_plan &plan, int term, const Array &gaps)
{
    const py::tuple columns = map_law(gaps, [&plan, term](double gap) {
        const nt_pressure flats = nt_plan_term_pressure(&plan, term, gap);
        return nt_law_value{flats.energy, flats.pressure, flats.slope, 0.0};
    });
    return py::make_tuple(columns[0], columns[1], columns[2]);
}

void bind_plan(py::module_ &module)
{
    module.def("term_rows", &term_rows);
    py::class_<nt_plan>(module, "Plan")
        .def("as_dict", &as_dict)
        .def_property_readonly("dents", [](const nt_plan &plan) { return plan.history == NT_HISTORY_DENTS; })
        .def("term_eval", &term_eval)
        .def("term_pressure", &term_pressure)
        .def("cutoff_gap", &nt_plan_cutoff_gap)
        .def("stable_step", &nt_plan_stable_step);
}
