// SPDX-License-Identifier: BSD-3-Clause
// contact_equilibrium.h in Maugis' units: arrays of lambda and of what is given, of one length. Equal
// lambdas should stand together (the Python side sorts): what is prepared for one serves its whole run.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "chapters.h"
#include "internal/contact.h"
#include "internal/contact_equilibrium.h"
#include "nanotouch/advanced/contact_equilibrium.h"

namespace
{

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// A contact of one lambda whose units are 1.
struct Prepared {
    nt_maugis maugis{};
    nt_status status;

    explicit Prepared(double lambda)
    {
        const nt_contact contact = {1.0, 0.75, 1.0 / NT_PI, 0.0};
        status = nt_maugis_init_lambda(&maugis, &contact, lambda);
    }
};

// Calls work(prepared, first, count) for each run of equal lambdas; `lambda` has one element for all or one for each.
template <class Work> void for_each_run(const Array &lambda, py::ssize_t count, Work work)
{
    const double *lambdas = lambda.data();
    const bool one = lambda.size() == 1;
    for (py::ssize_t first = 0, end = 0; first < count; first = end) {
        const double current = lambdas[one ? 0 : first];
        end = count;
        if (!one)
            end = std::find_if(lambdas + first, lambdas + count, [=](double l) { return l != current; }) - lambdas;
        if (end == first)
            end = first + 1; // NaN is unequal to itself
        work(Prepared(current), first, end - first);
    }
}

// States at loads or radii: {d, U, F, k, a}.
template <class At> py::tuple states(const Array &lambda, const Array &given, At at)
{
    std::vector<py::array_t<double>> columns;
    double *out[5];
    for (double *&column : out) {
        columns.emplace_back(given.size());
        column = columns.back().mutable_data();
    }
    const double *in = given.data();
    {
        py::gil_scoped_release release;
        for_each_run(lambda, given.size(), [&](const Prepared &made, py::ssize_t first, py::ssize_t count) {
            for (py::ssize_t i = first; i < first + count; ++i) {
                nt_contact_state state{nan, {nan, nan, nan, nan}};
                if (made.status == NT_OK)
                    (void)at(&made.maugis, in[i], &state); // untouched, so NaN, on failure
                const double row[5] = {state.indentation, state.value.U, state.value.F, state.value.k, state.value.a};
                for (int j = 0; j < 5; ++j)
                    out[j][i] = row[j];
            }
        });
    }
    return py::make_tuple(columns[0], columns[1], columns[2], columns[3], columns[4]);
}

// One row per lambda, in the order of Folds in contact/reduced.py; NaN for a lambda that is none.
py::array_t<double> folds(const Array &lambda)
{
    py::array_t<double> out({lambda.size(), py::ssize_t{8}});
    double *row = out.mutable_data();
    for_each_run(lambda, lambda.size(), [&](const Prepared &made, py::ssize_t, py::ssize_t count) {
        const nt_maugis_folds &f = made.maugis.folds;
        const double values[8] = {
            f.pull_off_load,    f.pull_off_radius, f.pull_off_indentation, static_cast<double>(f.grip_in_contact),
            f.grip_indentation, f.grip_load,       f.zero_load_radius,     f.zero_load_indentation};
        for (py::ssize_t i = 0; i < count; ++i, row += 8)
            for (int j = 0; j < 8; ++j)
                row[j] = made.status == NT_OK ? values[j] : nan;
    });
    return out;
}

} // namespace

void bind_contact_reduced(py::module_ &module)
{
    module.def(
        "reduced_at_load",
        [](const Array &lambda, const Array &P, int branch) {
            return states(lambda, P, [branch](const nt_maugis *maugis, double load, nt_contact_state *state) {
                return nt_maugis_at_load(maugis, load, static_cast<nt_branch>(branch), state);
            });
        },
        py::arg("lam"), py::arg("P"), py::arg("branch"));
    module.def(
        "reduced_at_radius", [](const Array &lambda, const Array &a) { return states(lambda, a, nt_maugis_at_radius); },
        py::arg("lam"), py::arg("a"));
    module.def("reduced_folds", &folds, py::arg("lam"));
    module.attr("lambda_min") = NT_MAUGIS_LAMBDA_MIN;
    module.attr("lambda_max") = NT_MAUGIS_LAMBDA_MAX;
}
