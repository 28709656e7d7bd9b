/* SPDX-License-Identifier: BSD-3-Clause
 * The readers' end: order, losses, torn frames, readers that are killed or stopped, writers that die. */
#define _POSIX_C_SOURCE 200809L
#include "frames_fixture.h"

#include <math.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/wait.h>
#include <time.h>

#include "internal/observer.h"
#include "session/frames_memory.h" /* one slot of the ring */

typedef struct ends {
    nt_frames *frames;
    nt_observer *observer;
} ends;

static ends open_ends(void)
{
    ends made = {NULL, NULL};
    assert_int_equal(nt_frames_create(&made.frames, NULL), NT_OK);
    assert_int_equal(nt_observer_of(&made.observer, made.frames), NT_OK);
    return made;
}

static void close_ends(ends *both)
{
    nt_observer_close(both->observer);
    nt_frames_close(both->frames);
}

/* Reads all there is; returns how many, and fails unless they are whole and follow each other. */
static long read_all(nt_observer *observer, uint64_t *last)
{
    nt_frame frames[100];
    long all = 0, got;
    while ((got = nt_observer_read(observer, frames, 100)) > 0)
        for (long i = 0; i < got; ++i, ++all) {
            assert_true(is_whole(&frames[i]));
            if (all > 0)
                assert_int_equal(frames[i].sequence, *last + 1);
            *last = frames[i].sequence;
        }
    return all;
}

static void frames_come_once_and_in_order(void **state)
{
    (void)state;
    ends both = open_ends();
    nt_frame frame;
    uint64_t last = 0;
    assert_int_equal(nt_observer_newest(both.observer, &frame), 0);
    assert_int_equal(nt_observer_read(both.observer, &frame, 1), 0);
    for (uint64_t tick = 0; tick < 3 * NT_FRAME_SLOTS; tick += 1000) { /* round the ring */
        publish(both.frames, tick, tick + 1000);
        assert_int_equal(nt_observer_newest(both.observer, &frame), 1);
        assert_int_equal(frame.sequence, tick + 999);
        assert_int_equal(read_all(both.observer, &last), 1000);
        assert_int_equal(last, tick + 999);
        assert_int_equal(nt_observer_read(both.observer, &frame, 1), 0);
    }
    assert_int_equal(nt_observer_missed(both.observer), 0);
    assert_int_equal(nt_observer_read(both.observer, &frame, 0), 0);
    close_ends(&both);
}

static void an_observer_begins_with_what_comes_next(void **state)
{
    (void)state;
    nt_frames *frames = NULL;
    nt_observer *late = NULL;
    nt_frame frame;
    uint64_t last = 0;
    assert_int_equal(nt_frames_create(&frames, NULL), NT_OK);
    publish(frames, 0, 10);
    assert_int_equal(nt_observer_of(&late, frames), NT_OK);
    assert_int_equal(nt_observer_newest(late, &frame), 1);
    assert_int_equal(frame.sequence, 9);
    assert_int_equal(nt_observer_read(late, &frame, 1), 0);
    publish(frames, 10, 13);
    assert_int_equal(read_all(late, &last), 3);
    assert_int_equal(nt_observer_missed(late), 0);
    nt_observer_close(late);
    nt_frames_close(frames);
}

/* A whole ring is kept; of more, the newer half, and the rest is counted. */
static void what_was_overwritten_is_counted(void **state)
{
    (void)state;
    const uint64_t sizes[] = {NT_FRAME_SLOTS - 1, NT_FRAME_SLOTS, NT_FRAME_SLOTS + 1, 10 * NT_FRAME_SLOTS + 7};
    for (size_t i = 0; i < 4; ++i) {
        ends both = open_ends();
        uint64_t last = 0;
        publish(both.frames, 0, sizes[i]);
        const long got = read_all(both.observer, &last);
        assert_int_equal(got, sizes[i] <= NT_FRAME_SLOTS ? sizes[i] : NT_FRAME_SLOTS / 2);
        assert_int_equal(nt_observer_missed(both.observer), sizes[i] - (uint64_t)got);
        assert_int_equal(last, sizes[i] - 1);
        close_ends(&both);
    }
}

/* A 60 Hz view of a 10 kHz session: 167 frames between two looks, 24 times less than the ring holds. */
static void sixty_looks_a_second_miss_nothing_at_10_kHz(void **state)
{
    (void)state;
    ends both = open_ends();
    uint64_t last = 0, all = 0;
    for (uint64_t look = 0; look < 600; ++look) { /* ten seconds; every hundredth look comes 0.38 s late */
        publish(both.frames, look * 10000 / 60, (look + 1) * 10000 / 60);
        if (look % 100 < 77 || look % 100 == 99)
            all += (uint64_t)read_all(both.observer, &last);
    }
    assert_int_equal(all, 100000);
    assert_int_equal(nt_observer_missed(both.observer), 0);
    close_ends(&both);
}

enum { ROUNDS = 200000 };

typedef struct watch {
    nt_observer *observer;
    uint64_t seen, torn, disorder;
    int reads_newest;
} watch;

/* Reads until the last frame has come. */
static void *watch_all(void *context)
{
    watch *w = context;
    nt_frame frames[64];
    uint64_t last = 0;
    while (last + 1 < ROUNDS) {
        const long got =
            w->reads_newest ? nt_observer_newest(w->observer, frames) : nt_observer_read(w->observer, frames, 64);
        for (long i = 0; i < got; ++i) {
            w->torn += !is_whole(&frames[i]);
            w->disorder += frames[i].sequence < last;
            last = frames[i].sequence;
            ++w->seen;
        }
        if (got == 0)
            sched_yield();
    }
    return NULL;
}

static void threads_read_no_torn_frame(void **state)
{
    (void)state;
    nt_frames *frames = NULL;
    watch watches[3] = {{.reads_newest = 0}, {.reads_newest = 1}, {.reads_newest = 0}};
    pthread_t threads[3];
    assert_int_equal(nt_frames_create(&frames, NULL), NT_OK);
    for (int i = 0; i < 3; ++i) {
        assert_int_equal(nt_observer_of(&watches[i].observer, frames), NT_OK);
        assert_int_equal(pthread_create(&threads[i], NULL, watch_all, &watches[i]), 0);
    }
    publish(frames, 0, ROUNDS);
    for (int i = 0; i < 3; ++i) {
        pthread_join(threads[i], NULL);
        assert_int_equal(watches[i].torn, 0);
        assert_int_equal(watches[i].disorder, 0);
        assert_true(watches[i].seen > 0);
        if (!watches[i].reads_newest)
            assert_int_equal(watches[i].seen + nt_observer_missed(watches[i].observer), ROUNDS);
        nt_observer_close(watches[i].observer);
    }
    nt_frames_close(frames);
}

static nt_frame_slot slot;
static atomic_int enough;

static void *write_one_slot(void *context)
{
    for (uint64_t tick = 1; !atomic_load(&enough); ++tick) {
        const nt_frame frame = frame_of(tick);
        nt_slot_write(&slot.stamp, slot.words, tick, &frame, FRAME_WORDS);
    }
    return context;
}

/* Writer and reader meet in one slot again and again, as they hardly ever do in the ring. */
static void a_slot_is_never_torn(void **state)
{
    (void)state;
    pthread_t writer;
    nt_frame frame;
    int wrong = 0;
    atomic_store(&enough, 0);
    assert_int_equal(pthread_create(&writer, NULL, write_one_slot, NULL), 0);
    for (int seen = 0; seen < 4 * ROUNDS;) {
        const uint64_t stamp = nt_slot_read(&slot.stamp, slot.words, &frame, FRAME_WORDS);
        wrong += stamp != 0 && (!is_whole(&frame) || frame.sequence != stamp);
        seen += stamp != 0;
    }
    atomic_store(&enough, 1);
    pthread_join(writer, NULL);
    assert_int_equal(wrong, 0);
}

static void *describe_often(void *context)
{
    static char text[2048];
    for (int i = 1; i <= 2000; ++i) {
        memset(text, 'a' + i % 26, sizeof text - 1);
        if (nt_frames_describe(context, text) != NT_OK)
            return context;
    }
    return NULL;
}

static void descriptions_are_never_torn(void **state)
{
    (void)state;
    static char text[NT_DESCRIPTION_SIZE];
    ends both = open_ends();
    pthread_t writer;
    uint32_t changes = 0;
    int torn = 0;
    assert_int_equal(pthread_create(&writer, NULL, describe_often, both.frames), 0);
    while (changes < 2000) {
        if (nt_observer_description(both.observer, text, &changes) != NT_OK || changes == 0)
            continue;
        const char expected[2] = {(char)('a' + changes % 26), '\0'};
        torn += strlen(text) != 2047 || strspn(text, expected) != 2047;
    }
    void *failed = NULL;
    pthread_join(writer, &failed);
    assert_null(failed);
    assert_int_equal(torn, 0);
    close_ends(&both);
}

/* A reader in a process of its own; ends with 0 if all it read was whole and in order. */
static pid_t start_reader(const char *name, int ready)
{
    const pid_t child = fork();
    if (child != 0)
        return child;
    watch w = {.reads_newest = 0};
    if (nt_observer_attach(&w.observer, name) != NT_OK || write(ready, "", 1) != 1)
        _exit(3);
    watch_all(&w);
    _exit(w.torn ? 1 : w.disorder ? 2 : 0);
}

/* Three readers: one is killed, one is stopped for half of the time. The writer does not notice. */
static void processes_read_no_torn_frame(void **state)
{
    (void)state;
    char name[NT_NAME_SIZE], bytes[3];
    int ready[2], how = -1;
    pid_t readers[3];
    nt_frames *frames = NULL;
    assert_int_equal(pipe(ready), 0);
    assert_int_equal(nt_frames_create(&frames, session_name(name, 0)), NT_OK);
    for (int i = 0; i < 3; ++i) {
        readers[i] = start_reader(name, ready[1]);
        assert_int_equal(read(ready[0], bytes, 1), 1);
    }
    for (uint64_t tick = 0; tick < ROUNDS; tick += ROUNDS / 100) {
        publish(frames, tick, tick + ROUNDS / 100);
        sched_yield();
        if (tick == ROUNDS / 4)
            kill(readers[0], SIGKILL);
        if (tick == ROUNDS / 4)
            kill(readers[1], SIGSTOP);
        if (tick == ROUNDS / 4 * 3)
            kill(readers[1], SIGCONT);
    }
    assert_int_equal(waitpid(readers[0], &how, 0), readers[0]);
    assert_true(WIFSIGNALED(how) || (WIFEXITED(how) && WEXITSTATUS(how) == 0));
    for (int i = 1; i < 3; ++i) {
        assert_int_equal(waitpid(readers[i], &how, 0), readers[i]);
        assert_true(WIFEXITED(how) && WEXITSTATUS(how) == 0);
    }
    nt_frames_close(frames);
    close(ready[0]);
    close(ready[1]);
}

/* No wall-clock limit is checked from above: a writer that closed is dead at once, one that is silent after a second.
 */
static void a_dead_writer_is_seen(void **state)
{
    (void)state;
    char name[NT_NAME_SIZE];
    nt_frames *frames = NULL;
    nt_observer *observer = NULL;
    assert_int_equal(nt_frames_create(&frames, session_name(name, 0)), NT_OK);
    assert_int_equal(nt_observer_attach(&observer, name), NT_OK);
    assert_true(nt_observer_silence(observer) >= 0.0);
    const struct timespec pause = {.tv_sec = 1, .tv_nsec = 1000000};
    nanosleep(&pause, NULL);
    assert_true(nt_observer_silence(observer) > NT_FRAMES_SILENCE);
    assert_int_equal(nt_observer_is_alive(observer), 0);
    const double before = nt_observer_silence(observer);
    nt_frames_beat(frames);
    assert_true(nt_observer_silence(observer) < before);
    publish(frames, 0, 3);
    nt_frames_close(frames);
    assert_true(isinf(nt_observer_silence(observer)));
    assert_int_equal(nt_observer_is_alive(observer), 0);
    uint64_t last = 0;
    assert_int_equal(read_all(observer, &last), 3); /* what it left can be read */
    nt_observer_close(observer);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_come_once_and_in_order),
        cmocka_unit_test(an_observer_begins_with_what_comes_next),
        cmocka_unit_test(what_was_overwritten_is_counted),
        cmocka_unit_test(sixty_looks_a_second_miss_nothing_at_10_kHz),
        cmocka_unit_test(threads_read_no_torn_frame),
        cmocka_unit_test(a_slot_is_never_torn),
        cmocka_unit_test(descriptions_are_never_torn),
        cmocka_unit_test(processes_read_no_torn_frame),
        cmocka_unit_test(a_dead_writer_is_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
