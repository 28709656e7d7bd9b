/* SPDX-License-Identifier: BSD-3-Clause
 * A half in a shared object: loaded, asked for its table, and checked before anything else of it is called. */
#if defined(__linux__)
#define _POSIX_C_SOURCE 200809L
#endif

#include "hal/clock.h"
#include "nanotouch/hal.h"

#include <stdio.h>

static nt_status refuse(nt_module *module, nt_status status, const char *path, const char *why)
{
    nt_hal_unload(module);
    (void)snprintf(module->text, sizeof module->text, "%.400s: %.400s", path, why);
    return status;
}

#if NT_HAS_SYSTEM

#include <string.h>

#if defined(_WIN32)

#include <windows.h>

static void *open_object(const char *path)
{
    WCHAR wide[1024];
    const int is_path = MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, wide, sizeof wide / sizeof *wide);
    return is_path ? (void *)LoadLibraryW(wide) : NULL;
}
static void close_object(void *handle)
{
    FreeLibrary((HMODULE)handle);
}
static nt_status refuse_object(nt_module *module, const char *path)
{
    const DWORD error = GetLastError();
    char why[64];
    if (error == ERROR_MOD_NOT_FOUND)
        return refuse(module, NT_E_DEVICE, path, "No such file, or one that it needs is missing");
    (void)snprintf(why, sizeof why, "Windows cannot load it: error %lu", (unsigned long)error);
    return refuse(module, NT_E_DEVICE, path, why);
}

#else

#include <dlfcn.h>

static void *open_object(const char *path)
{
    return dlopen(path, RTLD_NOW | RTLD_LOCAL);
}
static void close_object(void *handle)
{
    (void)dlclose(handle);
}
static nt_status refuse_object(nt_module *module, const char *path)
{
    const char *text = dlerror();
    const size_t length = strlen(path);
    if (!text)
        text = "cannot be loaded";
    else if (strncmp(text, path, length) == 0 && strncmp(text + length, ": ", 2) == 0)
        text += length + 2; /* the path is told already */
    return refuse(module, NT_E_DEVICE, path, text);
}

#endif

typedef const nt_backend *(*entry_point)(void);

/* Size and version come first in every version of the table; nothing behind them is looked at before they fit. */
static nt_status check_table(nt_module *module, const char *path, nt_half half)
{
    static const char *const halves[] = {"master", "slave"};
    const nt_backend *backend = module->backend;
    char why[128];
    if (!backend)
        return refuse(module, NT_E_ARGUMENT, path, NT_BACKEND_ENTRY " returns no table");
    if (backend->version != NT_HAL_API_VERSION || backend->size != sizeof *backend) {
        (void)snprintf(why, sizeof why, "written for version %u of the contract (%u bytes), this is version %u (%u)",
                       (unsigned)backend->version, (unsigned)backend->size, (unsigned)NT_HAL_API_VERSION,
                       (unsigned)sizeof *backend);
        return refuse(module, NT_E_UNSUPPORTED, path, why);
    }
    if (backend->half != half) {
        const int is_known = (unsigned)backend->half <= NT_HALF_SLAVE;
        (void)snprintf(why, sizeof why, "is a %s, a %s is wanted",
                       is_known ? halves[backend->half] : "half unknown here", halves[half]);
        return refuse(module, NT_E_UNSUPPORTED, path, why);
    }
    if (!backend->name || !backend->name[0])
        return refuse(module, NT_E_ARGUMENT, path, "its table has no name");
    if (!backend->read || !backend->write)
        return refuse(module, NT_E_ARGUMENT, path, "its table has no read or no write");
    return NT_OK;
}

static entry_point find_entry(void *handle)
{
#if defined(_WIN32)
    return (entry_point)(void (*)(void))GetProcAddress((HMODULE)handle, NT_BACKEND_ENTRY);
#else
    void *symbol = dlsym(handle, NT_BACKEND_ENTRY);
    entry_point entry;
    memcpy(&entry, &symbol, sizeof entry); /* what POSIX promises of dlsym, and C has no cast for */
    return entry;
#endif
}

nt_status nt_hal_load(nt_module *module, const char *path, nt_half half)
{
    if (!module || !path || (unsigned)half > NT_HALF_SLAVE)
        return NT_E_ARGUMENT;
    *module = (nt_module){.handle = open_object(path)};
    if (!module->handle)
        return refuse_object(module, path);
    const entry_point entry = find_entry(module->handle);
    if (!entry)
        return refuse(module, NT_E_ARGUMENT, path, "has no function " NT_BACKEND_ENTRY);
    module->backend = entry();
    return check_table(module, path, half);
}

void nt_hal_unload(nt_module *module)
{
    if (!module || !module->handle)
        return;
    close_object(module->handle);
    module->handle = NULL;
    module->backend = NULL;
}

#else

nt_status nt_hal_load(nt_module *module, const char *path, nt_half half)
{
    if (!module || !path || (unsigned)half > NT_HALF_SLAVE)
        return NT_E_ARGUMENT;
    *module = (nt_module){0};
    return refuse(module, NT_E_UNSUPPORTED, path, "this system loads no shared objects here");
}

void nt_hal_unload(nt_module *module)
{
    (void)module;
}

#endif
