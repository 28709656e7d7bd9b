/* SPDX-License-Identifier: BSD-3-Clause
 * A simulated session in contact that runs for a number of periods and is read, for an instruction counter
 * (bench_cycle.py runs it). Arguments: "hertz" (no force but elastic contact) or "default" (the scene of the defaults),
 * and how many periods. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "nanotouch/nanotouch.h"

enum { BLOCK = 1000 };
static nt_record records[BLOCK];

static void leave_hertz_only(nt_scene *scene)
{
    scene->medium.kind = NT_MEDIUM_VACUUM;
    scene->adhesion.work_of_adhesion = 0.0;
    scene->adhesion.hamaker_constant = 0.0;
    scene->adhesion.contact_potential = 0.0;
}

/* Pressed with 1 N. */
static nt_status run(nt_session *session, long periods)
{
    const nt_input input = {.operator_force[NT_Z] = 1.0, .duration = 0.5};
    nt_status status = nt_session_aim(session, &input, NULL);
    for (long i = 0; i < periods && status == NT_OK; i += BLOCK) {
        status = nt_session_advance(session, BLOCK);
        if (nt_session_read(session, records, BLOCK) != BLOCK)
            return NT_E_STATE;
    }
    return status;
}

int main(int argc, char **argv)
{
    const long periods = argc == 3 ? atol(argv[2]) : 0;
    if (periods < BLOCK || periods % BLOCK != 0) {
        (void)fprintf(stderr, "bench_cycle hertz|default PERIODS, in thousands\n");
        return 2;
    }
    nt_session_setup setup = nt_session_defaults();
    nt_session *session = NULL;
    setup.clearance = 20e-9;
    if (strcmp(argv[1], "hertz") == 0)
        leave_hertz_only(&setup.scene);
    nt_status status = nt_session_open(&session, &setup, NULL);
    if (status == NT_OK)
        status = run(session, periods);
    const int touches = records[BLOCK - 1].state == NT_RUN && records[BLOCK - 1].contact_radius > 0.0;
    nt_session_close(session);
    return status == NT_OK && touches ? 0 : 1;
}
