// SPDX-License-Identifier: BSD-3-Clause
// session.h: what a tip leaves on a simulated sample, dents and particles
#include <algorithm>

#include "session.h"

// The dents so far, the oldest first: [start x, start y, end x, end y, radius, depth, load, before].
static py::list dents_of(Session &self)
{
    nt_dents dents{};
    alone(self, [&](nt_session *h) {
        if (const nt_dents *found = nt_session_dents(h))
            dents = *found;
        return NT_OK;
    });
    py::list out;
    for (int i = 0; i < dents.count; ++i) {
        const nt_imprint &of = dents.made[i].imprint;
        out.append(py::make_tuple(of.start[0], of.start[1], of.end[0], of.end[1], of.radius, of.depth,
                                  dents.made[i].load, dents.made[i].before));
    }
    return out;
}

static void undent(Session &self)
{
    const nt_status status = alone(self, [](nt_session *h) { return nt_session_undent(h); });
    if (status == NT_E_STATE)
        raise(status, "undent: there is no dent, or the tip touches the sample");
    if (status == NT_E_UNSUPPORTED)
        raise(status, "undent: the sample keeps no dents (scene: sample.dents)");
    raise_on(status, "undent");
}

static void lay(Session &self, int number, double x, double y)
{
    const double place[] = {x, y};
    const nt_status status = alone(self, [&](nt_session *h) { return nt_session_lay(h, number, place); });
    if (status == NT_E_UNSUPPORTED)
        raise(status, "lay: the session was opened without particles");
    if (status == NT_E_STATE)
        raise(status, "lay: the tip or another particle touches it, where it is or where it shall lie");
    if (status == NT_E_CAPACITY)
        raise(status, "lay: numbers go up by one, to " + std::to_string(NT_PARTICLES - 1));
    raise_on(status, "lay");
}

static void lay_rod(Session &self, double x, double y, double angle)
{
    const double pose[] = {x, y, angle};
    const nt_status status = alone(self, [&](nt_session *h) { return nt_session_lay_rod(h, pose); });
    if (status == NT_E_UNSUPPORTED)
        raise(status, "lay_rod: the session was opened without a rod");
    if (status == NT_E_STATE)
        raise(status, "lay_rod: the tip touches it, where it is or where it shall lie: move the tip away first");
    raise_on(status, "lay_rod");
}

// What lies on the surface: {places, forces on the tip, touches, losses, radius, length, angles, stored, dissipated}.
static py::dict particles_of(Session &self)
{
    nt_session_particles found{};
    raise_on(alone(self, [&](nt_session *h) { return nt_session_read_particles(h, &found); }),
             "particles: the session was opened without particles and without a rod");
    const auto rows = [&](const double (*of)[NT_AXES]) {
        Array out(std::vector<py::ssize_t>{found.count, NT_AXES});
        std::copy(&of[0][0], &of[0][0] + NT_AXES * found.count, out.mutable_data());
        return out;
    };
    const auto numbers = [&](const uint32_t *of) { return std::vector<uint32_t>(of, of + found.count); };
    return py::dict(py::arg("positions") = rows(found.position), py::arg("forces") = rows(found.force),
                    py::arg("touches") = numbers(found.touches), py::arg("losses") = numbers(found.losses),
                    py::arg("radius") = found.radius, py::arg("length") = found.length,
                    py::arg("angles") = Array(found.count, found.angle), py::arg("stored") = found.stored,
                    py::arg("dissipated") = found.dissipated);
}

void bind_session_left(py::class_<Session> &type)
{
    type.def("dents", &dents_of).def("undent", &undent);
    type.def("lay", &lay).def("lay_rod", &lay_rod).def("particles", &particles_of);
}
