// SPDX-License-Identifier: BSD-3-Clause
// curves.h: what a measured force curve shows before any model is fitted
#include "internal/curves.h"
#include "chapters.h"

#include <array>

// A baseline crosses as the row of its numbers, in the order of the struct.
constexpr std::size_t baseline_terms = sizeof(nt_curve_baseline) / sizeof(double);
using Terms = std::array<double, baseline_terms>;
static_assert(sizeof(nt_curve_baseline) == 16 * sizeof(double), "nanotouch.curves.Baseline has these terms");

static Terms terms_of(const nt_curve_baseline &baseline)
{
    Terms terms;
    std::copy_n(reinterpret_cast<const double *>(&baseline), baseline_terms, terms.begin());
    return terms;
}

static nt_curve_baseline baseline_of(const Terms &terms)
{
    nt_curve_baseline baseline;
    std::copy(terms.begin(), terms.end(), reinterpret_cast<double *>(&baseline));
    return baseline;
}

static nt_curve_segment segment_of(const Array &z, const Array &force)
{
    if (z.ndim() != 1 || force.ndim() != 1 || z.size() != force.size())
        throw py::value_error("z and force must have one dimension and the same length");
    return {z.data(), force.data(), static_cast<long>(z.size())};
}

static std::vector<double> work_for(long points)
{
    return std::vector<double>(static_cast<std::size_t>(nt_curve_work_size(points)));
}

using Choice = std::tuple<int, double, double>; // kind, lowest, highest
static nt_curve_choice choice_of(const Choice &choice)
{
    return {static_cast<nt_curve_baseline_kind>(std::get<0>(choice)), std::get<1>(choice), std::get<2>(choice)};
}

static Array copied(const double *values, long count)
{
    return Array(static_cast<py::ssize_t>(count), values);
}

static py::object branch_dict(const nt_curve_branch &branch)
{
    if (branch.count == 0)
        return py::none();
    py::dict out;
    out["z"] = copied(branch.z, branch.count);
    out["force"] = copied(branch.force, branch.count);
    out["baseline"] = terms_of(branch.baseline);
    out["noise"] = branch.noise;
    out["visible"] = branch.visible;
    out["lowest"] = branch.lowest;
    out["dips"] = branch.dips != 0;
    out["tear"] = branch.torn < 0 ? py::object(py::none()) : py::int_(branch.torn);
    out["repulsive"] = branch.repulsive;
    out["dip"] = std::array<double, 3>{branch.dip.value, branch.dip_z, branch.dip.sigma};
    out["adhesion_work"] = std::array<double, 2>{branch.adhesion_work.value, branch.adhesion_work.sigma};
    out["contact_slope"] = std::array<double, 2>{branch.contact_slope.value, branch.contact_slope.sigma};
    return std::move(out);
}

static nt_curve_segment checked(const Array &z, const Array &force)
{
    const nt_curve_segment segment = segment_of(z, force);
    nt_problem problem = problem_of("points of a branch", "", double(segment.count), NT_CURVE_FEWEST, 1e9);
    const nt_status status = segment.count < NT_CURVE_FEWEST ? NT_E_RANGE : nt_curve_segment_check(&segment, &problem);
    raise_on(status, problem, "curve");
    return segment;
}

static Terms fit_baseline(const Array &z, const Array &force, const Choice &asked)
{
    const nt_curve_segment segment = checked(z, force);
    const nt_curve_choice choice = choice_of(asked);
    std::vector<double> work = work_for(segment.count);
    nt_curve_baseline baseline;
    nt_problem problem{};
    raise_on(nt_curve_fit_baseline(&segment, &choice, work.data(), &baseline, &problem), problem, "baseline");
    return terms_of(baseline);
}

static py::object read_branch(const Array &z, const Array &force, const Choice &asked)
{
    const nt_curve_segment segment = checked(z, force);
    const nt_curve_choice choice = choice_of(asked);
    std::vector<double> work = work_for(segment.count);
    nt_curve_branch branch;
    nt_problem problem{};
    raise_on(nt_curve_read_branch(&segment, &choice, work.data(), &branch, &problem), problem, "curve");
    return branch_dict(branch);
}

// A branch is (z, force), of no points where there is none.
static py::dict read_curve(const std::pair<Array, Array> &approach, const std::pair<Array, Array> &retract,
                           double spring_constant, const std::pair<double, double> &drag, const Choice &asked)
{
    const nt_curve curve = {segment_of(approach.first, approach.second), segment_of(retract.first, retract.second),
                            spring_constant, drag.first, drag.second};
    const nt_curve_choice choice = choice_of(asked);
    std::vector<double> work = work_for(curve.approach.count + curve.retract.count);
    nt_curve_reading reading;
    nt_problem problem{};
    nt_status status;
    {
        py::gil_scoped_release release;
        status = nt_curve_read(&curve, &choice, work.data(), &reading, &problem);
    }
    raise_on(status, problem, "curve");
    py::dict out, points;
    for (int i = 0; i < NT_CURVE_METHODS; ++i)
        if (!std::isnan(reading.contact_points[i]))
            points[nt_curve_contact_method_name(static_cast<nt_curve_contact_method>(i))] = reading.contact_points[i];
    out["approach"] = branch_dict(reading.approach);
    out["retract"] = branch_dict(reading.retract);
    py::list ruptures;
    for (int i = 0; i < reading.ruptures; ++i) {
        const nt_curve_rupture &rupture = reading.rupture[i];
        ruptures.append(py::make_tuple(rupture.z, rupture.force, rupture.slope, rupture.step));
    }
    out["ruptures"] = ruptures;
    out["support"] = int(reading.support);
    out["pull_off"] = std::array<double, 3>{reading.pull_off_least, reading.pull_off_most, reading.pull_off_sigma};
    out["offset"] = std::array<double, 2>{reading.offset, reading.offset_sigma};
    out["ringing"] = reading.ringing;
    out["contact_points"] = points;
    out["contact_point"] = std::array<double, 2>{reading.contact_point.value, reading.contact_point.sigma};
    return out;
}

static Array baseline_at(const Terms &terms, const Array &z)
{
    const nt_curve_baseline baseline = baseline_of(terms);
    Array out(std::vector<py::ssize_t>(z.shape(), z.shape() + z.ndim()));
    for (py::ssize_t i = 0; i < z.size(); ++i)
        out.mutable_data()[i] = nt_curve_baseline_at(&baseline, z.data()[i]);
    return out;
}

static std::pair<double, double> split_noise(const Array &rest, double scatter)
{
    const nt_curve_noise noise = nt_curve_split_noise(rest.data(), static_cast<long>(rest.size()), scatter);
    return {noise.white, noise.flicker};
}

static double point_noise(const Array &force)
{
    if (force.size() < 2)
        throw py::value_error("the noise of fewer than two points is unknown");
    std::vector<double> work(static_cast<std::size_t>(force.size()));
    return nt_curve_point_noise(force.data(), static_cast<long>(force.size()), work.data());
}

static double correlated_noise(double point_noise, const std::pair<double, double> &free, long count)
{
    const nt_curve_noise noise = {free.first, free.second};
    return nt_curve_correlated_noise(point_noise, &noise, count);
}

void bind_curves(py::module_ &module)
{
    py::dict kinds;
    kinds["auto"] = int(NT_CURVE_AUTO);
    kinds["line"] = int(NT_CURVE_LINE);
    kinds["wave"] = int(NT_CURVE_WAVE);
    kinds["constant"] = int(NT_CURVE_CONSTANT);
    kinds["between"] = int(NT_CURVE_BETWEEN);
    module.attr("baseline_kinds") = kinds;
    module.def("fit_baseline", &fit_baseline);
    module.def("read_branch", &read_branch);
    module.def("read_curve", &read_curve);
    module.def("baseline_at", &baseline_at);
    module.def("baseline_sigma", [](const Terms &terms, double z) {
        const nt_curve_baseline baseline = baseline_of(terms);
        return nt_curve_baseline_sigma(&baseline, z);
    });
    module.def("split_noise", &split_noise);
    module.def("point_noise", &point_noise);
    module.def("correlated_noise", &correlated_noise);
    module.def("residual_correlation", [](const Array &rest) {
        return nt_curve_residual_correlation(rest.data(), static_cast<long>(rest.size()));
    });
}
