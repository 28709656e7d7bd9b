// SPDX-License-Identifier: BSD-3-Clause
// hal_replay.h: a half that gives a recording again
#include "nanotouch/advanced/hal_replay.h"

#include "hal.h"

struct ReplayHalf : Half {
    Array time, position, felt;
    nt_replay_half half{};

    ReplayHalf(const py::object &given, nt_half which)
    {
        const py::tuple rows = given.attr("rows")(which == NT_HALF_MASTER ? "master" : "slave");
        const int axes = rows[0].cast<int>();
        time = rows[1].cast<Array>();
        position = rows[2].cast<Array>();
        felt = rows[3].cast<Array>();
        const nt_replay_rows found{time.size(), axes, time.data(), position.data(), felt.data()};
        nt_problem problem{};
        raise_on(nt_replay_half_init(&half, &found, &problem), problem, "replay");
        choice = {nt_replay_backend(which), &half};
    }
};

std::shared_ptr<Half> replay_half_of(const py::object &given, nt_half half)
{
    return std::make_shared<ReplayHalf>(given, half);
}
