/* SPDX-License-Identifier: BSD-3-Clause
 * Operators that solve the tasks, so that they are known to be solvable. Each sees frames, as a person sees a view, and
 * asks as a person asks: by the wheel, by moves, by choices. They know nothing of the law. */
#include <math.h>
#include <string.h>

#include "host/state.h"

static const double LOOK = 0.02;     /* between two looks [s] */
static const double LONGEST = 600.0; /* until the operator gives up [s] */

static double load_of(const nt_operator *op)
{
    return nt_session_setup_of(op->host->session)->scene.range.maximum_load;
}

int nt_operator_goes_on(const nt_operator *op)
{
    return op->status == NT_OK && !op->host->trainer.is_done;
}

const nt_frame *nt_operator_wait(nt_operator *op, double duration)
{
    if (op->status == NT_OK)
        op->status = op->clock->advance(op->clock->context, duration);
    op->time += duration;
    if (op->time > LONGEST && op->status == NT_OK)
        op->status = NT_E_NO_SOLUTION;
    return &op->host->frame;
}

void nt_operator_ask(nt_operator *op, const char *what, double x, double y, double z)
{
    if (op->status == NT_OK)
        (void)nt_host_ask(op->host, &(nt_host_asked){what, "", {x, y, z}});
}

const nt_frame *nt_operator_wheel(nt_operator *op, double steps)
{
    nt_operator_ask(op, "wheel", steps, 0.0, 0.0);
    return nt_operator_wait(op, LOOK);
}

/* Touch, then press with a force [N]. */
const nt_frame *nt_operator_down_to(nt_operator *op, double force)
{
    const nt_frame *frame = nt_operator_wheel(op, 0.0);
    while (nt_operator_goes_on(op) && !nt_frame_touches(frame))
        frame = nt_operator_wheel(op, 0.3);
    while (nt_operator_goes_on(op) && frame->tip_force[NT_Z] < force)
        frame = nt_operator_wheel(op, fmin(1.0, 0.1 + 20.0 * (force - frame->tip_force[NT_Z]) / load_of(op)));
    return frame;
}

void nt_operator_up(nt_operator *op)
{
    while (nt_operator_goes_on(op) && nt_frame_touches(nt_operator_wheel(op, -1.0)))
        ;
    for (int i = 0; i < 5; ++i)
        (void)nt_operator_wheel(op, -0.5);
}

/* Correct the height for one look, and go on along x by a way [m]. */
void nt_operator_hold(nt_operator *op, double force, double way)
{
    const double lacks = 40.0 * (force - op->host->frame.tip_force[NT_Z]) / load_of(op);
    if (way != 0.0)
        nt_operator_ask(op, "move", way, 0.0, 0.0);
    (void)nt_operator_wheel(op, fmin(fmax(lacks, -2.0), 2.0));
}

nt_status nt_host_solve(nt_session_host *host, const nt_host_clock *clock)
{
    nt_operator op = {.host = host, .clock = clock, .status = NT_OK};
    if (!host->trainer.task || host->trainer.is_done)
        return NT_E_STATE;
    host->trainer.task->solve(&op);
    return op.status != NT_OK ? op.status : host->trainer.is_done ? NT_OK : NT_E_NO_SOLUTION;
}
