// SPDX-License-Identifier: BSD-3-Clause
// An open session, and what has to outlive it.
#pragma once
#include <memory>
#include <mutex>
#include <vector>

#include "control.h"
#include "hal.h"
#include "internal/session.h"
#include "surface.h"

struct Session {
    nt_session *handle = nullptr;
    std::shared_ptr<Surface> surface; // these outlive the handle, as the law does
    std::shared_ptr<RadiusMap> radii;
    std::shared_ptr<Properties> properties;
    std::shared_ptr<OwnLaw> law = std::make_shared<OwnLaw>();
    std::shared_ptr<Half> master, slave;             // null: simulated
    std::unique_ptr<Described<nt_settings>> amounts; // what the law amounts to, where that is known
    std::mutex one_at_a_time;
    ~Session();
    // Raises what a law or a half written in Python has raised meanwhile.
    void rethrow()
    {
        law->rethrow();
        if (master)
            master->rethrow();
        if (slave)
            slave->rethrow();
    }
};

// A half or a law that calls the session which is calling it would wait for itself.
void refuse_inside(const Session &self);

// Python threads may share a session: one call at a time, waiting without the GIL.
template <class Call> auto alone(Session &self, Call call)
{
    refuse_inside(self);
    py::gil_scoped_release release;
    const std::lock_guard<std::mutex> lock(self.one_at_a_time);
    return call(self.handle);
}

using Records = std::vector<nt_record>;
using Shape = std::vector<py::ssize_t>;

// Records as arrays of a shape, by the names of the columns that a session of this kind has.
py::dict columns_of(const Session &self, const Records &records, const Shape &shape);

void bind_session_run(py::module_ &module, py::class_<Session> &type);
void bind_session_left(py::class_<Session> &type);
void bind_sessions(py::module_ &module);
