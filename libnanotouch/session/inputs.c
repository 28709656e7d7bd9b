/* SPDX-License-Identifier: BSD-3-Clause
 * What the operator does next: checked here, taken by the loop from the mailbox. */
#include <math.h>

#include "core/problem.h"
#include "internal/session.h"
#include "session/state.h"

nt_status nt_session_check_place(const nt_session *session, double x, double y, double duration, nt_problem *problem)
{
    static const char *const names[2][2] = {{"input.x", "input.y"},
                                            {"input.x beside the declared path", "input.y beside the declared path"}};
    const double (*borders)[2] = session->borders, to[] = {x, y};
    if (!(duration >= 0.0 && isfinite(duration)))
        return nt_problem_set(problem, "input.duration", "s", duration, 0.0, INFINITY);
    for (int i = NT_X; i < NT_Z; ++i)
        if (!isfinite(to[i]) || to[i] < borders[i][0] || to[i] > borders[i][1])
            return nt_problem_set(problem, names[session->keeps_to_path][i], "m", to[i], borders[i][0], borders[i][1]);
    return NT_OK;
}

static nt_status check_hand(const nt_session *session, const nt_input *input, nt_problem *problem)
{
    static const char *const sideways[] = {"input along x of a master of one axis",
                                           "input along y of a master of one axis"};
    const double travel = 0.5 * session->master_travel;
    if (input->holds != 0 && input->holds != 1)
        return nt_problem_set(problem, "input.holds", "no|yes", input->holds, 0.0, 1.0);
    for (int i = 0; i < NT_AXES; ++i) {
        if (!isfinite(input->operator_force[i]))
            return nt_problem_set(problem, "input.operator_force", "N", input->operator_force[i], -INFINITY, INFINITY);
        const double given = input->holds ? input->master_position[i] : input->operator_force[i];
        if (i != NT_Z && session->master_axes == 1.0 && given != 0.0)
            return nt_problem_set(problem, sideways[i], input->holds ? "m" : "N", given, 0.0, 0.0);
        if (input->holds && !(fabs(input->master_position[i]) <= travel))
            return nt_problem_set(problem, "input.master_position", "m", input->master_position[i], -travel, travel);
        if (!session->simulates[NT_HALF_MASTER] && (input->holds || input->operator_force[i] != 0.0)) {
            (void)nt_problem_set(problem,
                                 "input.operator_force of a device, which a hand leads (x and y of the tip may be "
                                 "scripted)",
                                 "N", input->operator_force[i], 0.0, 0.0);
            return NT_E_UNSUPPORTED;
        }
    }
    return NT_OK;
}

nt_status nt_session_check_input(const nt_session *session, const nt_input *input, nt_problem *problem)
{
    if (!session || !input)
        return NT_E_ARGUMENT;
    if (!(input->duration >= 0.0 && isfinite(input->duration)))
        return nt_problem_set(problem, "input.duration", "s", input->duration, 0.0, INFINITY);
    const nt_status status = check_hand(session, input, problem);
    if (status != NT_OK || (isnan(input->x) && isnan(input->y)))
        return status;
    return nt_session_check_place(session, input->x, input->y, input->duration, problem);
}

nt_status nt_session_aim(nt_session *session, const nt_input *input, nt_problem *problem)
{
    const nt_status status = nt_session_check_input(session, input, problem);
    if (status == NT_OK && nt_session_events_are_full(session))
        return NT_E_CAPACITY; /* it could not be replayed */
    if (status == NT_OK)
        nt_mailbox_post(&session->mailbox, input);
    return status;
}
