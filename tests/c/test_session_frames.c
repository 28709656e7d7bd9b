/* SPDX-License-Identifier: BSD-3-Clause
 * The writer's end: names, owners, what is left over, the description. */
#define _POSIX_C_SOURCE 200809L
#include "frames_fixture.h"

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include "assertions.h"
#include "internal/observer.h"
#include "session/frames.h"

/* The system's name for a block of a session. */
static const char *system_name(char *full, const char *kind, const char *name)
{
    snprintf(full, 128, "/nanotouch.%s.%s", kind, name);
    return full;
}

static int block_exists(const char *kind, const char *name)
{
    char full[128];
    const int file = shm_open(system_name(full, kind, name), O_RDONLY, 0);
    if (file >= 0)
        close(file);
    return file >= 0;
}

static void an_unknown_frame_says_so(void **state)
{
    (void)state;
    const nt_frame frame = nt_frame_unknown();
    assert_int_equal(sizeof frame, 184);
    assert_int_equal(frame.size, sizeof frame);
    assert_int_equal(frame.version, NT_FRAME_VERSION);
    double numbers[19]; /* time .. neck_radius */
    memcpy(numbers, &frame.time, sizeof numbers);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; ++i)
        assert_true(isnan(numbers[i]));
    assert_true(offsetof(nt_frame, state) - offsetof(nt_frame, time) == sizeof numbers);
    assert_true(frame.state == 0 && frame.reasons == 0 && frame.phase == 0 && frame.changes == 0);
}

static void bad_names_are_refused(void **state)
{
    (void)state;
    nt_frames *frames = NULL;
    nt_observer *observer = NULL;
    char too_long[NT_NAME_SIZE + 1];
    memset(too_long, 'a', NT_NAME_SIZE);
    too_long[NT_NAME_SIZE] = '\0';
    const char *const bad[] = {"", "a/b", "../a", "a b", "\xc3\xa4", too_long};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        assert_int_equal(nt_frames_create(&frames, bad[i]), NT_E_RANGE);
        assert_int_equal(nt_observer_attach(&observer, bad[i]), NT_E_RANGE);
    }
    assert_null(frames);
    assert_null(observer);
    assert_int_equal(nt_frames_create(NULL, "a"), NT_E_ARGUMENT);
    assert_int_equal(nt_observer_attach(&observer, NULL), NT_E_ARGUMENT);
    nt_frames_close(NULL);
    nt_observer_close(NULL);
    nt_client_close(NULL);
}

static void one_name_has_one_writer(void **state)
{
    (void)state;
    char name[NT_NAME_SIZE];
    nt_frames *frames = NULL, *second = NULL;
    assert_int_equal(nt_frames_create(&frames, session_name(name, 0)), NT_OK);
    assert_int_equal(nt_frames_create(&second, name), NT_E_STATE);
    assert_null(second);
    const pid_t child = fork();
    if (child == 0)
        _exit(nt_frames_create(&second, name) == NT_E_STATE ? 0 : 1);
    int how = -1;
    assert_int_equal(waitpid(child, &how, 0), child);
    assert_int_equal(how, 0);
    assert_true(block_exists("frames", name) && block_exists("commands", name)); /* the refused ones removed nothing */
    nt_frames_close(frames);
    assert_false(block_exists("frames", name) || block_exists("commands", name));
    assert_int_equal(nt_frames_create(&frames, name), NT_OK);
    nt_frames_close(frames);
}

static void only_this_user_may_open_them(void **state)
{
    (void)state;
    char name[NT_NAME_SIZE], full[128];
    const char *const kinds[] = {"frames", "commands"};
    nt_frames *frames = NULL;
    struct stat found;
    const mode_t before = umask(0);
    assert_int_equal(nt_frames_create(&frames, session_name(name, 0)), NT_OK);
    umask(before);
    for (size_t i = 0; i < 2; ++i) {
        const int file = shm_open(system_name(full, kinds[i], name), O_RDONLY, 0);
        assert_true(file >= 0);
        assert_int_equal(fstat(file, &found), 0);
        close(file);
        assert_int_equal(found.st_mode & 0777, 0600);
    }
    nt_frames_close(frames);
}

/* A writer that is killed leaves its blocks; its observer keeps what it has; the name is free again. */
static void what_a_dead_writer_left_is_replaced(void **state)
{
    (void)state;
    char name[NT_NAME_SIZE];
    int ready[2];
    session_name(name, 0);
    assert_int_equal(pipe(ready), 0);
    const pid_t child = fork();
    if (child == 0) {
        nt_frames *frames;
        if (nt_frames_create(&frames, name) != NT_OK)
            _exit(1);
        publish(frames, 1, 8);
        (void)!write(ready[1], "", 1);
        for (;;)
            pause();
    }
    char byte;
    assert_int_equal(read(ready[0], &byte, 1), 1);
    nt_observer *old = NULL, *fresh = NULL;
    nt_frames *frames = NULL;
    assert_int_equal(nt_observer_attach(&old, name), NT_OK);
    assert_int_equal(nt_frames_create(&frames, name), NT_E_STATE);
    kill(child, SIGKILL);
    assert_int_equal(waitpid(child, NULL, 0), child);
    assert_true(block_exists("frames", name));
    assert_int_equal(nt_frames_create(&frames, name), NT_OK);
    nt_frame frame;
    assert_int_equal(nt_observer_newest(old, &frame), 1);
    assert_true(is_whole(&frame) && frame.sequence == 7);
    assert_int_equal(nt_observer_attach(&fresh, name), NT_OK);
    assert_int_equal(nt_observer_newest(fresh, &frame), 0);
    nt_observer_close(old);
    nt_observer_close(fresh);
    nt_frames_close(frames);
    close(ready[0]);
    close(ready[1]);
}

/* Some other program's object, or another version's, is no session. */
static void foreign_objects_are_refused(void **state)
{
    (void)state;
    char name[NT_NAME_SIZE], full[128];
    nt_observer *observer = NULL;
    session_name(name, 0);
    assert_int_equal(nt_observer_attach(&observer, name), NT_E_DEVICE); /* none */
    const int file = shm_open(system_name(full, "frames", name), O_RDWR | O_CREAT | O_EXCL, 0600);
    assert_true(file >= 0);
    assert_int_equal(nt_observer_attach(&observer, name), NT_E_DEVICE); /* empty: being made */
    assert_int_equal(ftruncate(file, 4096), 0);
    assert_int_equal(nt_observer_attach(&observer, name), NT_E_DEVICE); /* nobody holds it */
    assert_int_equal(flock(file, LOCK_EX), 0);
    assert_int_equal(nt_observer_attach(&observer, name), NT_E_UNSUPPORTED);
    close(file);
    nt_frames *frames = NULL;
    assert_int_equal(nt_frames_create(&frames, name), NT_OK); /* nobody holds it: replaced */
    assert_int_equal(nt_observer_attach(&observer, name), NT_OK);
    nt_observer_close(observer);
    nt_frames_close(frames);
}

static void the_description_counts_its_changes(void **state)
{
    (void)state;
    static char text[NT_DESCRIPTION_SIZE], large[NT_DESCRIPTION_SIZE + 1];
    nt_frames *frames = NULL;
    nt_observer *observer = NULL;
    uint32_t changes = 99;
    assert_int_equal(nt_frames_create(&frames, NULL), NT_OK);
    assert_int_equal(nt_observer_of(&observer, frames), NT_OK);
    assert_int_equal(nt_observer_description(observer, text, &changes), NT_OK);
    assert_true(changes == 0 && text[0] == '\0');
    const char *const texts[] = {"{\"radius\": 2e-8}", "", "seven..", "eight..."};
    for (uint32_t i = 0; i < 4; ++i) {
        assert_int_equal(nt_frames_describe(frames, texts[i]), NT_OK);
        assert_int_equal(nt_frames_changes(frames), i + 1);
        assert_int_equal(nt_observer_description(observer, text, &changes), NT_OK);
        assert_string_equal(text, texts[i]);
        assert_int_equal(changes, i + 1);
    }
    memset(large, 'x', NT_DESCRIPTION_SIZE);
    assert_int_equal(nt_frames_describe(frames, large), NT_E_CAPACITY);
    assert_int_equal(nt_frames_describe(frames, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_observer_description(observer, text, NULL), NT_OK);
    assert_string_equal(text, "eight...");
    large[NT_DESCRIPTION_SIZE - 1] = '\0';
    assert_int_equal(nt_frames_describe(frames, large), NT_OK);
    assert_int_equal(nt_observer_description(observer, text, &changes), NT_OK);
    assert_string_equal(text, large);
    nt_observer_close(observer);
    nt_frames_close(frames);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_unknown_frame_says_so),
        cmocka_unit_test(bad_names_are_refused),
        cmocka_unit_test(one_name_has_one_writer),
        cmocka_unit_test(only_this_user_may_open_them),
        cmocka_unit_test(what_a_dead_writer_left_is_replaced),
        cmocka_unit_test(foreign_objects_are_refused),
        cmocka_unit_test(the_description_counts_its_changes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
