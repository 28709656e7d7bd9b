// SPDX-License-Identifier: BSD-3-Clause
// advanced/manipulation.h: what a tip moves, spheres or a rod, as a session leads it
#include <algorithm>
#include <array>

#include "chapters.h"

enum { OF_BODY = 4 }; // x, y, z of its middle, angle

static void put(const nt_pushed_state &state, double *row)
{
    for (int i = 0; i < state.count; ++i, row += OF_BODY) {
        std::copy(state.bodies[i].place, state.bodies[i].place + 3, row);
        row[3] = state.bodies[i].angle;
    }
}

static nt_pushed_state begin(const nt_pushed &self, const std::array<double, 3> &base)
{
    nt_pushed_state state{};
    raise_on(nt_pushed_begin(&self, base.data(), &state), "pushed: the tip begins above the substrate");
    return state;
}

static nt_pushed_state lay(const nt_pushed &self, nt_pushed_state state, int number, const std::array<double, 3> &pose)
{
    raise_on(nt_pushed_lay(&self, &state, number, pose.data()),
             "pushed: a place on the substrate that neither the tip nor another one touches");
    return state;
}

static py::tuple run(const nt_pushed &self, nt_pushed_state state, const Array &bases)
{
    const Array rows = run_along(bases, OF_BODY * state.count, "pushed", [&](const double *base, double *row) {
        nt_pushed_state to;
        const nt_status status = nt_pushed_advance(&self, &state, base, &to);
        if (status == NT_OK)
            nt_pushed_copy(&self, &state, &to);
        put(state, row);
        return status;
    });
    return py::make_tuple(state, rows);
}

static std::vector<double> poses_of(const nt_pushed_state &state)
{
    std::vector<double> row(OF_BODY * state.count);
    put(state, row.data());
    return row;
}

void bind_pushed(py::module_ &module)
{
    py::class_<nt_pushed_state>(module, "PushedState").def("read", &poses_of);
    py::class_<nt_pushed>(module, "Pushed")
        .def(py::init([](const nt_particles &of, double lever) {
            const nt_pushed given = nt_pushed_particles(&of);
            return nt_pushed_under(&given, lever);
        }))
        .def(py::init([](const nt_rod &of, double lever) {
            const nt_pushed given = nt_pushed_rod(&of);
            return nt_pushed_under(&given, lever);
        }))
        .def("begin", &begin)
        .def("lay", &lay)
        .def("run", &run);
}
