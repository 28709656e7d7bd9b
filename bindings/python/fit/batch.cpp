// SPDX-License-Identifier: BSD-3-Clause
// fit.h, second part: many recorded curves at once.
#include "batch.h"
#include "internal/fit.h"

#include <array>
#include <functional>
#include <tuple>
#include <vector>

using Column = std::function<double(const nt_fit_outcome &)>;

static Array column_of(const std::vector<nt_fit_outcome> &outcomes, const Column &column)
{
    Array values(static_cast<py::ssize_t>(outcomes.size()));
    for (std::size_t i = 0; i < outcomes.size(); ++i)
        values.mutable_data()[i] = column(outcomes[i]);
    return values;
}

template <class Value, class Get>
static py::array_t<Value> parameters_of(const std::vector<nt_fit_outcome> &outcomes, Get get)
{
    py::array_t<Value> values({static_cast<py::ssize_t>(outcomes.size()), py::ssize_t(NT_FIT_PARAMETERS)});
    for (std::size_t i = 0; i < outcomes.size(); ++i)
        for (int p = 0; p < NT_FIT_PARAMETERS; ++p)
            values.mutable_at(i, p) = Value(get(outcomes[i].fit)[p]);
    return values;
}

static void add_measured(py::dict *out, const std::vector<nt_fit_outcome> &outcomes, const char *name,
                         nt_curve_measured nt_fit_reading::*quantity)
{
    const std::string sigma = std::string(name) + "_sigma";
    (*out)[name] = column_of(outcomes, [=](const nt_fit_outcome &o) { return (o.reading.*quantity).value; });
    (*out)[sigma.c_str()] = column_of(outcomes, [=](const nt_fit_outcome &o) { return (o.reading.*quantity).sigma; });
}

// One sentence for each curve without a result.
static py::dict reasons_of(const std::vector<nt_fit_outcome> &outcomes)
{
    py::dict reasons;
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        const nt_fit_outcome &outcome = outcomes[i];
        char text[256];
        if (outcome.status != NT_OK)
            reasons[py::int_(i)] = outcome.problem.field ? nt_problem_print(&outcome.problem, text, sizeof text)
                                                         : nt_status_message(outcome.status);
    }
    return reasons;
}

static py::dict columns_of(const std::vector<nt_fit_outcome> &outcomes)
{
    py::dict out;
    out["value"] = parameters_of<double>(outcomes, [](const nt_fit_result &fit) { return fit.value; });
    out["sigma"] = parameters_of<double>(outcomes, [](const nt_fit_result &fit) { return fit.sigma; });
    out["identifiable"] = parameters_of<bool>(outcomes, [](const nt_fit_result &fit) { return fit.identifiable; });
    out["with_sensitivity"] = parameters_of<double>( // covariance with it
        outcomes, [](const nt_fit_result &fit) { return fit.covariance[NT_FIT_SENSITIVITY]; });
    out["status"] = column_of(outcomes, [](const nt_fit_outcome &o) { return double(o.status); });
    out["flags"] = column_of(outcomes, [](const nt_fit_outcome &o) { return double(o.flags); });
    out["residual_rms"] = column_of(outcomes, [](const nt_fit_outcome &o) { return o.fit.residual_rms; });
    out["contact_radius"] = column_of(outcomes, [](const nt_fit_outcome &o) { return o.fit.contact_radius; });
    out["contact_stiffness"] = column_of(outcomes, [](const nt_fit_outcome &o) { return o.fit.contact_stiffness; });
    out["noise"] = column_of(outcomes, [](const nt_fit_outcome &o) { return o.reading.noise; });
    out["baseline_tilt"] = column_of(outcomes, [](const nt_fit_outcome &o) { return o.reading.baseline_tilt; });
    add_measured(&out, outcomes, "snap_in_force", &nt_fit_reading::snap_in_force);
    add_measured(&out, outcomes, "pull_off_force", &nt_fit_reading::pull_off_force);
    add_measured(&out, outcomes, "adhesion_work", &nt_fit_reading::adhesion_work);
    add_measured(&out, outcomes, "contact_slope", &nt_fit_reading::contact_slope);
    add_measured(&out, outcomes, "branch_offset", &nt_fit_reading::offset);
    out["rating"] = column_of(outcomes, [](const nt_fit_outcome &o) { return o.rating; });
    out["pull_off_least"] = column_of(outcomes, [](const nt_fit_outcome &o) { return o.reading.pull_off_least; });
    out["pull_off_most"] = column_of(outcomes, [](const nt_fit_outcome &o) { return o.reading.pull_off_most; });
    out["ruptures"] = column_of(outcomes, [](const nt_fit_outcome &o) { return double(o.reading.ruptures); });
    out["reason"] = reasons_of(outcomes);
    return out;
}

// Curve i: its approach is z, force from edges[2 i] to edges[2 i + 1], its retraction from there to edges[2 i + 2].
static py::dict batch(const nt_fit_recipe &recipe, const Array &z, const Array &force,
                      const py::array_t<long long, py::array::c_style | py::array::forcecast> &edges,
                      const Array &spring_constant, int threads)
{
    const py::ssize_t count = spring_constant.size();
    if (z.ndim() != 1 || force.ndim() != 1 || z.size() != force.size())
        throw py::value_error("z and force must have one dimension and the same length");
    if (edges.ndim() != 1 || edges.size() != 2 * count + 1)
        throw py::value_error("edges must have 2 n + 1 elements for n spring constants");
    const long long *edge = edges.data();
    for (py::ssize_t i = 0; i < 2 * count + 1; ++i)
        if (edge[i] < (i ? edge[i - 1] : 0) || edge[i] > z.size())
            throw py::value_error("edges must grow and stay within z");
    const auto segment = [&](py::ssize_t i) {
        return nt_curve_segment{z.data() + edge[i], force.data() + edge[i], static_cast<long>(edge[i + 1] - edge[i])};
    };
    std::vector<nt_curve> curves;
    for (py::ssize_t i = 0; i < count; ++i)
        curves.push_back({segment(2 * i), segment(2 * i + 1), spring_constant.data()[i], 0.0, 0.0});
    std::vector<nt_fit_outcome> outcomes(curves.size());
    const nt_fit_curves all{curves.data(), static_cast<long>(count), threads};
    nt_status status;
    {
        py::gil_scoped_release release;
        status = nt_fit_batch(&recipe, &all, outcomes.data());
    }
    raise_on(status, "batch");
    return columns_of(outcomes);
}

static double rating(const Array &indentation, const Array &force, const Array &fitted, double noise)
{
    if (indentation.ndim() != 1 || force.size() != indentation.size() || fitted.size() != indentation.size())
        throw py::value_error("indentation, force and fitted must have one dimension and the same length");
    const nt_fit_rated rated{indentation.data(), force.data(), fitted.data(), static_cast<long>(force.size()), noise};
    return nt_fit_rating(&rated);
}

// baseline: force, slope, z_mean, nearest, scatter
static std::tuple<bool, double, double> begins_in_contact(const Array &z, const Array &force,
                                                          const std::array<double, 5> &baseline, double noise,
                                                          double spring_constant)
{
    if (z.ndim() != 1 || force.ndim() != 1 || z.size() != force.size() || z.size() == 0)
        throw py::value_error("z and force must have one dimension and the same length");
    nt_curve_branch branch{};
    branch.z = z.data();
    branch.force = force.data();
    branch.count = static_cast<long>(z.size());
    branch.baseline.force = baseline[0];
    branch.baseline.slope = baseline[1];
    branch.baseline.z_mean = baseline[2];
    branch.baseline.nearest = baseline[3];
    branch.baseline.scatter = baseline[4];
    double further = 0.0, left = 0.0;
    const bool begins = nt_fit_begins_in_contact(&branch, noise, spring_constant, &further, &left) != 0;
    return {begins, further, left};
}

// Of an analysed branch (nanotouch.curves.Branch) what nt_fit_branch_doubts reads.
static nt_curve_branch branch_of(const py::object &found, const Array &z, const Array &force)
{
    nt_curve_branch branch{};
    if (z.ndim() != 1 || force.ndim() != 1 || z.size() != force.size())
        throw py::value_error("z and force must have one dimension and the same length");
    branch.z = z.data();
    branch.force = force.data();
    branch.count = static_cast<long>(z.size());
    branch.noise = found.attr("noise").cast<double>();
    branch.dips = found.attr("dips").cast<bool>();
    branch.torn = found.attr("tear").is_none() ? -1 : found.attr("tear").cast<long>();
    const auto [depth, at, sigma] = found.attr("dip").cast<std::tuple<double, double, double>>();
    branch.dip = {depth, sigma};
    branch.dip_z = at;
    branch.contact_slope.value = std::get<0>(found.attr("contact_slope").cast<std::tuple<double, double>>());
    return branch;
}

static std::pair<unsigned, double> branch_doubts(const py::object &approach, const py::object &retract, int ruptures,
                                                 const std::array<double, 3> &fitted)
{
    const Array z[2] = {approach.attr("z").cast<Array>(), retract.attr("z").cast<Array>()},
                force[2] = {approach.attr("force").cast<Array>(), retract.attr("force").cast<Array>()};
    const nt_curve_branch one = branch_of(approach, z[0], force[0]), other = branch_of(retract, z[1], force[1]);
    const nt_fit_branches branches = {&one, &other, ruptures, fitted[0], fitted[1], fitted[2]};
    double kept_back;
    const unsigned doubts = nt_fit_branch_doubts(&branches, &kept_back);
    return {doubts, kept_back};
}

static nt_fit_recipe recipe_of(const Options &options)
{
    if (options.own)
        throw py::value_error("a law in Python cannot be called from many threads");
    nt_fit_recipe recipe = nt_fit_recipe_defaults(options.model);
    const double loss_scale = recipe.options.loss_scale;
    recipe.options = options;
    recipe.options.loss_scale = loss_scale;
    return recipe;
}

static void check(const nt_fit_recipe &recipe)
{
    nt_problem problem;
    raise_on(nt_fit_recipe_check(&recipe, &problem), problem, "fit");
}

static py::dict flag_bits()
{
    py::dict flags;
    flags["not_converged"] = int(NT_FIT_NOT_CONVERGED);
    flags["stiff"] = int(NT_FIT_STIFF);
    flags["misfit"] = int(NT_FIT_MISFIT);
    flags["wide"] = int(NT_FIT_WIDE);
    flags["calibration"] = int(NT_FIT_CALIBRATION);
    flags["wrong_model"] = int(NT_FIT_WRONG_MODEL);
    flags["waves"] = int(NT_FIT_WAVES);
    flags["torn_elsewhere"] = int(NT_FIT_TORN_ELSEWHERE);
    flags["uneven"] = int(NT_FIT_UNEVEN);
    flags["begins_in_contact"] = int(NT_FIT_BEGINS_IN_CONTACT);
    flags["imprecise"] = int(NT_FIT_IMPRECISE);
    flags["other_power"] = int(NT_FIT_OTHER_POWER);
    flags["adhesive"] = int(NT_FIT_ADHESIVE);
    flags["hysteresis"] = int(NT_FIT_HYSTERESIS);
    return flags;
}

void bind_batch(py::module_ &module)
{
    py::dict statuses;
    module.attr("flags") = flag_bits();
#define NT_STATUS_ENTRY(code, message) statuses[#code] = int(code);
    NT_STATUS_LIST(NT_STATUS_ENTRY)
#undef NT_STATUS_ENTRY
    module.attr("statuses") = statuses;
    py::class_<nt_fit_recipe>(module, "Recipe")
        .def(py::init(&recipe_of), py::arg("options"))
        .def("check", &check)
        .def_property(
            "approach", [](const nt_fit_recipe &r) { return r.approach != 0; },
            [](nt_fit_recipe &r, bool approach) { r.approach = approach; })
        .def_property(
            "loss_scale", [](const nt_fit_recipe &r) { return r.options.loss_scale; },
            [](nt_fit_recipe &r, double scale) { r.options.loss_scale = scale; })
        .def_property(
            "baseline", // kind of baseline_kinds, ends [m]
            [](const nt_fit_recipe &r) {
                return std::make_tuple(int(r.baseline.kind), r.baseline.lowest, r.baseline.highest);
            },
            [](nt_fit_recipe &r, std::tuple<int, double, double> choice) {
                const auto [kind, lowest, highest] = choice;
                r.baseline = {static_cast<nt_curve_baseline_kind>(kind), lowest, highest};
            })
        .def_property(
            "fit_offset", [](const nt_fit_recipe &r) { return r.fit_offset != 0; },
            [](nt_fit_recipe &r, bool fit_offset) { r.fit_offset = fit_offset; })
        .def("hold",
             [](nt_fit_recipe &r, int place) { // in Options.parameters
                 if (place < 0 || place >= NT_FIT_PARAMETERS)
                     throw py::index_error();
                 r.held[place] = 1;
             })
        .def_readwrite("lowest_force", &nt_fit_recipe::lowest_force)
        .def_readwrite("highest_force", &nt_fit_recipe::highest_force)
        .def_readwrite("sensitivity_uncertainty", &nt_fit_recipe::sensitivity_uncertainty);
    module.attr("good_rating") = NT_FIT_GOOD;
    module.def("begins_in_contact", &begins_in_contact, py::arg("z"), py::arg("force"), py::arg("baseline"),
               py::arg("noise"), py::arg("spring_constant"));
    module.def("branch_doubts", &branch_doubts, py::arg("approach"), py::arg("retract"), py::arg("ruptures"),
               py::arg("fitted")); // spring constant [N/m], contact point as z [m], sigma of the power
    module.def("rating", &rating, py::arg("indentation"), py::arg("force"), py::arg("fitted"), py::arg("noise"));
    module.def("batch", &batch, py::arg("recipe"), py::arg("z"), py::arg("force"), py::arg("edges"),
               py::arg("spring_constant"), py::arg("threads"));
}
