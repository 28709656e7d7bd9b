/* SPDX-License-Identifier: BSD-3-Clause
 * What observers see of one tick. */
#include <math.h>

#include "session/state.h"

nt_frame nt_session_frame(const nt_session *session, const nt_record *record)
{
    const nt_probe *probe = &session->now->touch.rig.probe;
    nt_frame frame = nt_frame_unknown();
    frame.sequence = record->tick;
    frame.time = record->time;
    frame.base_height = nt_session_start_height(session) - record->stage_position[NT_Z];
    frame.deflection = record->deflection[NT_Z];
    frame.tip_position[NT_X] = record->stage_position[NT_X];
    frame.tip_position[NT_Y] = record->stage_position[NT_Y];
    frame.tip_position[NT_Z] = frame.base_height + record->deflection[NT_Z] * cos(probe->tilt);
    for (int i = 0; i < NT_AXES; ++i) {
        frame.tip_force[i] = record->tip_force[i];
        frame.master_position[i] = record->master_position[i];
        frame.motor_force[i] = record->motor_force[i];
    }
    frame.gap = record->gap;
    frame.contact_radius = record->contact_radius;
    frame.state = record->state;
    frame.reasons = record->reasons;
    frame.phase = record->phase;
    frame.changes = session->frames ? nt_frames_changes(session->frames) : 0u;
    return frame;
}
