/* SPDX-License-Identifier: BSD-3-Clause
 * Private: a block of memory that has a name and one owner. The owner holds a lock on it, which the system takes away
 * when its process ends, however it ends: so a block without a lock is left over and may go. */
#ifndef NANOTOUCH_HAL_SHARED_MEMORY_H
#define NANOTOUCH_HAL_SHARED_MEMORY_H

#include <stddef.h>
#include <stdint.h>

#include "nanotouch/status.h"

enum {
    NT_GIVEN_NAME_SIZE = 65, /* [byte] of the name that a user gives, with its ending 0 */
    NT_SHARED_NAME_SIZE = 96 /* of the system's */
};

typedef struct nt_shared {
    void *memory; /* whole pages; NULL: none */
    size_t size;  /* [byte] */
    int file;     /* the owner's; -1: none */
    long owner;   /* its process: a copy of it by fork is none */
    char name[NT_SHARED_NAME_SIZE];
} nt_shared;

/* All 0 at first. kind: "frames", "commands", "mailbox" or "claim", part of the system's name for it. name NULL:
 * private memory. NT_E_STATE if a living owner, or another user, has the name; NT_E_RANGE for a bad name;
 * NT_E_NO_MEMORY; NT_E_DEVICE if the system refuses otherwise. After a failure nothing needs to be closed. What killed
 * programs of this user have left is removed, under whatever name. */
nt_status nt_shared_create(nt_shared *shared, const char *kind, const char *name, size_t size);
/* Is this the process that made it? Asks the system. */
int nt_shared_is_own(const nt_shared *shared);
/* NT_E_DEVICE if it is not there or its owner has ended, NT_E_UNSUPPORTED if it has another size, NT_E_STATE if it
 * shall be writable and is another user's. */
nt_status nt_shared_attach(nt_shared *shared, const char *kind, const char *name, size_t size, int writable);
/* Gives the memory back; the owner's block is removed, by the owner alone. May be repeated. */
void nt_shared_close(nt_shared *shared);

/* For these functions alone: the system's name of a block; NT_E_RANGE for a bad one. */
nt_status nt_shared_make_name(char *full, const char *kind, const char *name);

#endif
