/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what hal.h does not promise. */
#ifndef NANOTOUCH_HAL_HAL_PRIVATE_H
#define NANOTOUCH_HAL_HAL_PRIVATE_H

#include "nanotouch/hal.h"

/* Both halves as they were last read, as one sample of tick `tick` at time `now` [ns]. */
NT_REALTIME void nt_hal_join(const nt_hal *master, const nt_hal *slave, uint64_t tick, int64_t now, nt_sample *sample);
/* Reads both halves as one sample of tick `tick` at time `now` [ns]; the first status that is not NT_OK. */
NT_REALTIME nt_status nt_hal_sample(nt_hal *master, nt_hal *slave, uint64_t tick, int64_t now, nt_sample *sample);
/* The command to both halves at time `now` [ns]; the first status that is not NT_OK. */
NT_REALTIME nt_status nt_hal_command(nt_hal *master, nt_hal *slave, const nt_command *command, nt_action *action);

#endif
