// SPDX-License-Identifier: BSD-3-Clause
// Many sessions at once, each on whichever processor is free: they share nothing that changes, so that their records do
// not depend on how many threads there are.
#include <algorithm>
#include <atomic>
#include <thread>

#include "session.h"

namespace
{

using Several = std::vector<Session *>;

// work(i) for every i, in so many threads, this one among them.
template <class Work> void spread(size_t count, int threads, Work work)
{
    std::atomic<size_t> next{0};
    const auto run = [&] {
        for (size_t i = next++; i < count; i = next++)
            work(i);
    };
    std::vector<std::thread> others;
    for (size_t i = 1; i < std::min(count, static_cast<size_t>(std::max(threads, 1))); ++i)
        others.emplace_back(run);
    run();
    for (std::thread &other : others)
        other.join();
}

std::string name_of(size_t which)
{
    return "session " + std::to_string(which);
}

// What is aimed at, after so many ticks from now on, in order.
using Script = std::vector<std::pair<long, nt_input>>;

// Every input is looked at before any session moves.
void check_inputs(const Several &sessions, const std::vector<Script> &scripts)
{
    nt_problem problem{};
    for (size_t i = 0; i < scripts.size(); ++i)
        for (const auto &[at, input] : scripts[i])
            raise_on(nt_session_check_input(sessions[i]->handle, &input, &problem), problem,
                     name_of(i) + ", operator input");
}

nt_status run(nt_session *session, const Script &script, long ticks)
{
    long done = 0;
    nt_status status = NT_OK;
    for (const auto &[at, input] : script) {
        status = nt_session_advance(session, at - done);
        if (status == NT_OK)
            status = nt_session_aim(session, &input, nullptr);
        if (status != NT_OK)
            return status;
        done = at;
    }
    return nt_session_advance(session, ticks - done);
}

// So many ticks of each; `scripts` has one for each, or none.
void advance_sessions(const Several &sessions, const std::vector<Script> &scripts, long ticks, int threads)
{
    for (const Session *session : sessions)
        refuse_inside(*session);
    check_inputs(sessions, scripts);
    std::vector<nt_status> statuses(sessions.size(), NT_OK);
    {
        const py::gil_scoped_release release;
        const Script none;
        spread(sessions.size(), threads, [&](size_t i) {
            const std::lock_guard<std::mutex> lock(sessions[i]->one_at_a_time);
            statuses[i] = run(sessions[i]->handle, scripts.empty() ? none : scripts[i], ticks);
        });
    }
    for (size_t i = 0; i < sessions.size(); ++i) {
        sessions[i]->rethrow();
        if (statuses[i] == NT_E_CAPACITY)
            raise(statuses[i], name_of(i) + ": the ring of records is full: read them first");
        raise_on(statuses[i], name_of(i) + ", advance");
    }
}

// So many rows of each, as arrays of (session, row).
py::dict read_sessions(const Several &sessions, long rows)
{
    Records records(sessions.size() * static_cast<size_t>(rows));
    py::dict out;
    for (size_t i = 0; i < sessions.size(); ++i) {
        nt_record *first = records.data() + i * static_cast<size_t>(rows);
        const long got = alone(*sessions[i], [&](nt_session *handle) { return nt_session_read(handle, first, rows); });
        const uint64_t ticks = nt_session_progress(sessions[i]->handle).ticks;
        if (got != rows || (rows > 0 && first[rows - 1].tick + 1 != ticks))
            raise(NT_E_STATE, name_of(i) + ": it has been run on its own, and its records wait to be read");
    }
    return columns_of(*sessions[0], records, {static_cast<py::ssize_t>(sessions.size()), rows});
}

} // namespace

void bind_sessions(py::module_ &module)
{
    module.def("advance_sessions", &advance_sessions, py::arg("sessions"), py::arg("scripts"), py::arg("ticks"),
               py::arg("threads"));
    module.def("read_sessions", &read_sessions, py::arg("sessions"), py::arg("rows"));
}
