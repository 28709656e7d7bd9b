/* SPDX-License-Identifier: BSD-3-Clause
 * A file system with two files, 0 and 1, that answer spidev's requests: the driver's real system calls reach it through
 * the kernel. It speaks the kernel's FUSE protocol itself, from a thread of the test, in a name space of its own, so
 * that nothing of it outlives the test. The buffers that a message points to lie in this process. */
#ifndef TESTS_FUSE_SPIDEV_H
#define TESTS_FUSE_SPIDEV_H

#include <fcntl.h>
#include <linux/fuse.h>
#include <pthread.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include "spidev_model.h"

typedef struct fuse_spidev {
    int device;
    char folder[32], path[2][48];
    spidev_model model[2];
    pthread_t serving;
} fuse_spidev;

static inline int copy_here(void *context, uint64_t theirs, uint8_t *ours, uint32_t count, int is_write)
{
    (void)context;
    if (theirs && is_write)
        memcpy((void *)(uintptr_t)theirs, ours, count);
    else if (theirs)
        memcpy(ours, (const void *)(uintptr_t)theirs, count);
    else if (!is_write)
        memset(ours, 0, count);
    return 0;
}

static inline void fuse_reply(const fuse_spidev *f, uint64_t unique, int error, const void *body, size_t size)
{
    struct fuse_out_header head = {(uint32_t)(sizeof head + (error ? 0 : size)), error, unique};
    const struct iovec parts[] = {{&head, sizeof head}, {(void *)(uintptr_t)body, error ? 0 : size}};
    (void)!writev(f->device, parts, 2);
}

static inline struct fuse_attr fuse_attributes(uint64_t node)
{
    return (struct fuse_attr){.ino = node, .mode = node == 1 ? S_IFDIR | 0755 : S_IFREG | 0666, .nlink = 1};
}

static inline void fuse_control(fuse_spidev *f, const struct fuse_in_header *head, const uint8_t *body)
{
    const struct fuse_ioctl_in *in = (const void *)body;
    struct {
        struct fuse_ioctl_out out;
        uint8_t argument[1024];
    } reply = {{0, 0, 0, 0}, {0}};
    memcpy(reply.argument, body + sizeof *in,
           in->in_size < sizeof reply.argument ? in->in_size : sizeof reply.argument);
    const int result = model_request(&f->model[head->nodeid - 2], in->cmd, reply.argument, copy_here, NULL);
    reply.out.result = result;
    fuse_reply(f, head->unique, result < 0 ? result : 0, &reply, sizeof reply.out + in->out_size);
}

static inline void fuse_look_up(const fuse_spidev *f, const struct fuse_in_header *head, const char *name)
{
    const int chip = name[1] == 0 && (name[0] == '0' || name[0] == '1') ? name[0] - '0' : -1;
    const uint64_t node = (uint64_t)(2 + chip);
    const struct fuse_entry_out out = {
        .nodeid = node, .attr_valid = 1000, .entry_valid = 1000, .attr = fuse_attributes(node)};
    fuse_reply(f, head->unique, chip < 0 ? -ENOENT : 0, &out, sizeof out);
}

static inline void fuse_answer(fuse_spidev *f, const struct fuse_in_header *head, const uint8_t *body)
{
    const struct fuse_init_in *init = (const void *)body;
    const struct fuse_init_out started = {.major = FUSE_KERNEL_VERSION,
                                          .minor = init->minor < 31 ? init->minor : 31,
                                          .max_readahead = 0,
                                          .max_write = 4096};
    const struct fuse_attr_out attributes = {.attr_valid = 1000, .attr = fuse_attributes(head->nodeid)};
    const struct fuse_open_out opened = {.open_flags = FOPEN_DIRECT_IO};
    switch (head->opcode) {
    case FUSE_INIT:
        fuse_reply(f, head->unique, 0, &started, sizeof started);
        break;
    case FUSE_LOOKUP:
        fuse_look_up(f, head, (const char *)body);
        break;
    case FUSE_GETATTR:
        fuse_reply(f, head->unique, 0, &attributes, sizeof attributes);
        break;
    case FUSE_OPEN:
        fuse_reply(f, head->unique, 0, &opened, sizeof opened);
        break;
    case FUSE_IOCTL:
        fuse_control(f, head, body);
        break;
    case FUSE_FORGET:
    case FUSE_BATCH_FORGET:
        break; /* want no answer */
    case FUSE_RELEASE:
    case FUSE_FLUSH:
        fuse_reply(f, head->unique, 0, NULL, 0);
        break;
    default:
        fuse_reply(f, head->unique, -ENOSYS, NULL, 0);
    }
}

static inline void *fuse_serve(void *context)
{
    fuse_spidev *f = context;
    static _Alignas(8) uint8_t request[FUSE_MIN_READ_BUFFER + 8192];
    for (;;) {
        const ssize_t count = read(f->device, request, sizeof request);
        if (count < 0 && (errno == EINTR || errno == ENOENT || errno == EAGAIN))
            continue;
        if (count < (ssize_t)sizeof(struct fuse_in_header))
            return NULL; /* unmounted */
        fuse_answer(f, (const void *)request, request + sizeof(struct fuse_in_header));
    }
}

/* Why it cannot run here, or NULL. */
static inline const char *fuse_start(fuse_spidev *f, simulated_bus *bus)
{
    char options[96];
    *f = (fuse_spidev){.folder = "/tmp/nanotouch-spi-XXXXXX"};
    if (unshare(CLONE_NEWNS) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0)
        return "no name space of one's own";
    (void)mount("none", "/", NULL, MS_REC | MS_PRIVATE, NULL);
    f->device = open("/dev/fuse", O_RDWR | O_CLOEXEC);
    if (f->device < 0)
        return "no /dev/fuse";
    if (!mkdtemp(f->folder))
        return "no folder";
    (void)snprintf(options, sizeof options, "fd=%d,rootmode=40000,user_id=%u,group_id=%u", f->device, getuid(),
                   getgid());
    if (mount("nanotouch", f->folder, "fuse", MS_NOSUID | MS_NODEV, options) != 0) {
        (void)rmdir(f->folder);
        return "FUSE may not be mounted";
    }
    for (int i = 0; i < 2; ++i) {
        f->model[i] = (spidev_model){.bus = bus, .chip = i, .clock = 500000, .bits = 8};
        (void)snprintf(f->path[i], sizeof f->path[i], "%s/%d", f->folder, i);
    }
    return pthread_create(&f->serving, NULL, fuse_serve, f) == 0 ? NULL : "no thread";
}

static inline void fuse_end(fuse_spidev *f)
{
    (void)umount2(f->folder, 0);
    (void)pthread_join(f->serving, NULL);
    (void)close(f->device);
    (void)rmdir(f->folder);
}

#endif
