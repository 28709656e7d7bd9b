/* SPDX-License-Identifier: BSD-3-Clause
 * POSIX shared memory, with the owner's lock by flock, which Linux offers on it and others do not. Windows:
 * shared_memory_windows.c. */
#if defined(__linux__)
#define _DEFAULT_SOURCE
#endif

#include "hal/shared_memory.h"

#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

#if defined(_WIN32)
#define NAME_OF_SYSTEM "Local\\" /* of this login */
#else
#define NAME_OF_SYSTEM "/"
#endif

nt_status nt_shared_make_name(char *full, const char *kind, const char *name)
{
    static const char allowed[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-";
    const size_t length = strlen(name);
    if (length == 0 || length >= NT_GIVEN_NAME_SIZE || strspn(name, allowed) != length)
        return NT_E_RANGE;
    snprintf(full, NT_SHARED_NAME_SIZE, NAME_OF_SYSTEM "nanotouch.%s.%s", kind, name);
    return NT_OK;
}

#if defined(__linux__) && ATOMIC_LLONG_LOCK_FREE == 2

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

static nt_status status_of(int error)
{
    switch (error) {
    case ENOSPC:
    case ENOMEM:
        return NT_E_NO_MEMORY;
    case EACCES: /* another user's */
    case EPERM:
    case EEXIST: /* somebody was faster */
    case EWOULDBLOCK:
        return NT_E_STATE;
    default:
        return NT_E_DEVICE;
    }
}

/* Opens the object of that name and locks it. NT_E_STATE if its owner lives. */
static nt_status open_locked(const char *full, int flags, int *file)
{
    struct stat found;
    nt_status status = NT_OK;
    const int opened = shm_open(full, O_RDWR | O_CREAT | flags, 0600);
    if (opened < 0)
        return status_of(errno);
    if (flock(opened, LOCK_EX | LOCK_NB) != 0 || fstat(opened, &found) != 0 || fchmod(opened, 0600) != 0)
        status = status_of(errno);
    else if (found.st_uid != geteuid() || found.st_nlink == 0) /* removed between open and lock: somebody is faster */
        status = NT_E_STATE;
    if (status == NT_OK)
        *file = opened;
    else
        close(opened);
    return status;
}

/* Removes one object if its owner has ended: nobody else ever holds the lock of a whole one. */
static void remove_left_over(const char *entry)
{
    struct stat found;
    char full[NT_SHARED_NAME_SIZE];
    snprintf(full, sizeof full, NAME_OF_SYSTEM "%s", entry);
    const int opened = shm_open(full, O_RDONLY | O_NONBLOCK, 0);
    if (opened < 0)
        return;
    if (fstat(opened, &found) == 0 && S_ISREG(found.st_mode) && found.st_uid == geteuid() && found.st_size > 0 &&
        flock(opened, LOCK_SH | LOCK_NB) == 0 && fstat(opened, &found) == 0 && found.st_nlink > 0)
        shm_unlink(full);
    close(opened);
}

/* What killed programs of this user have left, under whatever name: else each kill would cost its memory until the
 * machine is started again. */
static void remove_left_overs(void)
{
    static const char ours[] = "nanotouch.";
    DIR *folder = opendir("/dev/shm");
    if (!folder)
        return;
    for (const struct dirent *entry = readdir(folder); entry; entry = readdir(folder))
        if (strncmp(entry->d_name, ours, sizeof ours - 1) == 0 && strlen(entry->d_name) + 2 <= NT_SHARED_NAME_SIZE)
            remove_left_over(entry->d_name);
    closedir(folder);
}

/* A new, empty, locked object. What is left over is removed, never shortened: others may have it mapped. */
static nt_status open_new(const char *full, int *file)
{
    struct stat found;
    nt_status status = open_locked(full, 0, file);
    if (status != NT_OK || (fstat(*file, &found) == 0 && found.st_size == 0))
        return status;
    const int left_over = *file;
    shm_unlink(full);
    status = open_locked(full, O_EXCL, file);
    close(left_over);
    return status;
}

/* file -1: private memory. Every page is there before the loop needs it. */
static nt_status map(nt_shared *shared, int protection)
{
    const int flags = shared->file < 0 ? MAP_PRIVATE | MAP_ANONYMOUS : MAP_SHARED;
    void *memory = mmap(NULL, shared->size, protection, flags | MAP_POPULATE, shared->file, 0);
    if (memory == MAP_FAILED)
        return status_of(errno);
    shared->memory = memory;
    return NT_OK;
}

/* In a process that was forked off the owner it stays. */
static void remove_object(nt_shared *shared)
{
    if (shared->file < 0)
        return;
    if (nt_shared_is_own(shared))
        shm_unlink(shared->name);
    close(shared->file);
    shared->file = -1;
}

int nt_shared_is_own(const nt_shared *shared)
{
    return shared->owner == (long)getpid();
}

nt_status nt_shared_create(nt_shared *shared, const char *kind, const char *name, size_t size)
{
    *shared = (nt_shared){.size = size, .file = -1, .owner = (long)getpid()};
    if (!name)
        return map(shared, PROT_READ | PROT_WRITE);
    nt_status status = nt_shared_make_name(shared->name, kind, name);
    if (status == NT_OK) {
        remove_left_overs();
        status = open_new(shared->name, &shared->file);
    }
    if (status != NT_OK)
        return status;
    const int error = posix_fallocate(shared->file, 0, (off_t)size); /* a full system says so here, not in the loop */
    status = error ? status_of(error) : map(shared, PROT_READ | PROT_WRITE);
    if (status != NT_OK)
        remove_object(shared);
    return status;
}

nt_status nt_shared_attach(nt_shared *shared, const char *kind, const char *name, size_t size, int writable)
{
    *shared = (nt_shared){.size = size, .file = -1};
    struct stat found;
    nt_status status = nt_shared_make_name(shared->name, kind, name);
    if (status != NT_OK)
        return status;
    shared->file = shm_open(shared->name, writable ? O_RDWR : O_RDONLY, 0);
    if (shared->file < 0)
        return errno == EACCES && writable ? NT_E_STATE : NT_E_DEVICE;
    if (fstat(shared->file, &found) == 0 && writable && found.st_uid != geteuid()) /* what it says would be obeyed */
        status = NT_E_STATE;
    else if (fstat(shared->file, &found) != 0 || found.st_size == 0 || flock(shared->file, LOCK_SH | LOCK_NB) == 0)
        status = NT_E_DEVICE; /* who gets the lock has found what an ended owner has left */
    else if (found.st_size != (off_t)size)
        status = NT_E_UNSUPPORTED;
    else
        status = map(shared, writable ? PROT_READ | PROT_WRITE : PROT_READ);
    close(shared->file);
    shared->file = -1; /* not ours to remove */
    return status;
}

void nt_shared_close(nt_shared *shared)
{
    if (shared->memory)
        munmap(shared->memory, shared->size);
    shared->memory = NULL;
    remove_object(shared);
}

#elif !defined(_WIN32) /* whose own file has it */

nt_status nt_shared_create(nt_shared *shared, const char *kind, const char *name, size_t size)
{
    (void)shared, (void)kind, (void)name, (void)size;
    return NT_E_UNSUPPORTED;
}

nt_status nt_shared_attach(nt_shared *shared, const char *kind, const char *name, size_t size, int writable)
{
    (void)shared, (void)kind, (void)name, (void)size, (void)writable;
    return NT_E_UNSUPPORTED;
}

void nt_shared_close(nt_shared *shared)
{
    (void)shared;
}

int nt_shared_is_own(const nt_shared *shared)
{
    (void)shared;
    return 1;
}

#endif
