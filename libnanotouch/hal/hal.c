/* SPDX-License-Identifier: BSD-3-Clause */
#include <stddef.h>

#include "nanotouch/hal.h"

nt_status nt_hal_open(nt_hal *hal, const nt_hal_backend *backend, void *context)
{
    if (!backend || !backend->read || !backend->write)
        return NT_E_ARGUMENT;
    if (backend->api_version != NT_HAL_API_VERSION)
        return NT_E_UNSUPPORTED;
    hal->backend = backend;
    hal->context = context;
    return NT_OK;
}

nt_status nt_hal_read(nt_hal *hal, nt_sample *sample)
{
    return hal->backend ? hal->backend->read(hal->context, sample) : NT_E_STATE;
}

nt_status nt_hal_write(nt_hal *hal, const nt_command *command)
{
    return hal->backend ? hal->backend->write(hal->context, command) : NT_E_STATE;
}

void nt_hal_close(nt_hal *hal)
{
    if (!hal || !hal->backend)
        return;
    if (hal->backend->close)
        hal->backend->close(hal->context);
    hal->backend = NULL;
    hal->context = NULL;
}
