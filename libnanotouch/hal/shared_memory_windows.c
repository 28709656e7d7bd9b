/* SPDX-License-Identifier: BSD-3-Clause
 * Shared memory of Windows: a section of the paging file. Its name lasts as long as its owner, who alone keeps a handle
 * to it; who has it mapped keeps the memory and not the name. So nothing is left over, and no lock is needed. */
#include "hal/shared_memory.h"

#if defined(_WIN32)

#include <string.h>
#include <windows.h>

enum {
    TRIES = 20, /* [ms]; who attaches has a handle for a moment */
    PAGE = 4096 /* [byte]; what is mapped is told in whole ones */
};

static nt_status last_status(void)
{
    switch (GetLastError()) {
    case ERROR_NOT_ENOUGH_MEMORY:
    case ERROR_COMMITMENT_LIMIT:
    case ERROR_DISK_FULL:
        return NT_E_NO_MEMORY;
    case ERROR_ACCESS_DENIED: /* another user's */
        return NT_E_STATE;
    default:
        return NT_E_DEVICE;
    }
}

/* A section that was not there before. name NULL: one without. */
static nt_status make_section(const char *name, uint64_t size, HANDLE *section)
{
    for (int i = 0; i < TRIES; ++i) {
        *section = CreateFileMappingA(INVALID_HANDLE_VALUE, NULL, PAGE_READWRITE | SEC_COMMIT, (DWORD)(size >> 32),
                                      (DWORD)size, name);
        if (!*section)
            return last_status();
        if (GetLastError() != ERROR_ALREADY_EXISTS)
            return NT_OK;
        CloseHandle(*section);
        Sleep(1);
    }
    return NT_E_STATE;
}

nt_status nt_shared_create(nt_shared *shared, const char *kind, const char *name, size_t size)
{
    *shared = (nt_shared){.size = size, .file = -1, .owner = (long)GetCurrentProcessId()};
    HANDLE section = NULL;
    nt_status status = name ? nt_shared_make_name(shared->name, kind, name) : NT_OK;
    if (status == NT_OK)
        status = make_section(name ? shared->name : NULL, size, &section);
    if (status != NT_OK)
        return status;
    shared->file = (int)(intptr_t)section; /* a handle has 32 bits, so that 32-bit processes can hold it */
    shared->memory = MapViewOfFile(section, FILE_MAP_ALL_ACCESS, 0, 0, size);
    if (shared->memory) {
        memset(shared->memory, 0, size); /* every page is there before the loop needs it */
        return NT_OK;
    }
    status = last_status();
    nt_shared_close(shared);
    return status;
}

int nt_shared_is_own(const nt_shared *shared)
{
    return shared->owner == (long)GetCurrentProcessId();
}

nt_status nt_shared_attach(nt_shared *shared, const char *kind, const char *name, size_t size, int writable)
{
    *shared = (nt_shared){.size = size, .file = -1};
    const DWORD access = writable ? FILE_MAP_READ | FILE_MAP_WRITE : FILE_MAP_READ;
    nt_status status = nt_shared_make_name(shared->name, kind, name);
    if (status != NT_OK)
        return status;
    HANDLE section = OpenFileMappingA(access, FALSE, shared->name);
    if (!section)
        return NT_E_DEVICE;
    shared->memory = MapViewOfFile(section, access, 0, 0, 0);
    CloseHandle(section);
    MEMORY_BASIC_INFORMATION found = {.RegionSize = 0};
    if (!shared->memory || !VirtualQuery(shared->memory, &found, sizeof found))
        status = NT_E_DEVICE;
    else if (found.RegionSize != (size + PAGE - 1) / PAGE * PAGE)
        status = NT_E_UNSUPPORTED;
    if (status != NT_OK)
        nt_shared_close(shared);
    return status;
}

void nt_shared_close(nt_shared *shared)
{
    if (shared->memory)
        UnmapViewOfFile(shared->memory);
    shared->memory = NULL;
    if (shared->file != -1)
        CloseHandle((HANDLE)(intptr_t)shared->file);
    shared->file = -1;
}

#else

typedef int nt_is_not_windows; /* ISO C wants a declaration */

#endif
