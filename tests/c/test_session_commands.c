/* SPDX-License-Identifier: BSD-3-Clause
 * Requests and answers: the lease, stops without it, and clients that die or scribble. */
#define _POSIX_C_SOURCE 200809L
#include "frames_fixture.h"

#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <time.h>

#include "session/frames_memory.h" /* what a scribbler writes into */

enum { GAIN = 7 }; /* some kind of the session's */

typedef struct ends {
    nt_frames *frames;
    nt_client *one, *other;
} ends;

static ends open_ends(void)
{
    ends made = {NULL, NULL, NULL};
    assert_int_equal(nt_frames_create(&made.frames, NULL), NT_OK);
    assert_int_equal(nt_client_of(&made.one, made.frames), NT_OK);
    assert_int_equal(nt_client_of(&made.other, made.frames), NT_OK);
    return made;
}

static void close_ends(ends *all)
{
    nt_client_close(all->one);
    nt_client_close(all->other);
    nt_frames_close(all->frames);
}

static nt_request gain_of(double value)
{
    return (nt_request){.kind = GAIN, .field = 3, .value = {value, -value, 1.0, 0.0}};
}

static void sleep_for(double seconds)
{
    const struct timespec time = {.tv_sec = (time_t)seconds,
                                  .tv_nsec = (long)(1e9 * (seconds - (double)(long)seconds))};
    nanosleep(&time, NULL);
}

/* Takes one request, which must be there, and answers it. */
static nt_request serve(nt_frames *frames, uint64_t tick, nt_status status, uint32_t pending)
{
    nt_request taken;
    assert_int_equal(nt_frames_take(frames, &taken), 1);
    const nt_answer answer = {.id = taken.id, .tick = tick, .status = (int32_t)status, .pending = pending};
    nt_frames_answer(frames, &answer);
    return taken;
}

static void a_request_is_taken_and_answered(void **state)
{
    (void)state;
    ends all = open_ends();
    nt_request request = gain_of(2.5), taken;
    nt_answer answer;
    assert_int_equal(nt_frames_take(all.frames, &taken), 0);
    assert_int_equal(nt_client_lease(all.one), NT_OK);
    assert_int_equal(nt_client_post(all.one, &request), NT_OK);
    assert_int_equal(nt_client_poll(all.one, request.id, &answer), NT_OK);
    assert_true(answer.pending == 1 && answer.tick == 0); /* not yet taken */
    taken = serve(all.frames, 41, NT_OK, 1);
    assert_memory_equal(&taken, &request, sizeof taken);
    assert_int_equal(nt_frames_take(all.frames, &taken), 0); /* once */
    assert_int_equal(nt_client_poll(all.one, request.id, &answer), NT_OK);
    assert_true(answer.pending == 1 && answer.tick == 41);
    const nt_answer last = {.id = request.id, .tick = 97, .status = NT_E_RANGE};
    nt_frames_answer(all.frames, &last);
    assert_int_equal(nt_client_poll(all.one, request.id, &answer), NT_OK);
    assert_memory_equal(&answer, &last, sizeof last);
    close_ends(&all);
}

static void without_the_lease_only_a_stop_passes(void **state)
{
    (void)state;
    ends all = open_ends();
    nt_request request = gain_of(1.0), stop = {.kind = NT_REQUEST_STOP}, again = stop, taken;
    nt_answer answer;
    assert_int_equal(nt_client_post(all.other, &request), NT_E_STATE);
    assert_int_equal(nt_client_lease(all.one), NT_OK);
    assert_int_equal(nt_client_lease(all.other), NT_E_STATE);
    assert_int_equal(nt_client_post(all.other, &request), NT_E_STATE);
    assert_int_equal(nt_client_post(all.one, &request), NT_OK);
    assert_int_equal(nt_client_post(all.other, &stop), NT_OK);
    assert_int_equal(nt_client_post(all.one, &again), NT_OK);
    assert_int_equal(nt_client_poll(all.other, stop.id, &answer), NT_OK);
    assert_int_equal(answer.pending, 1);
    taken = serve(all.frames, 5, NT_OK, 0); /* first, and both as one */
    assert_int_equal(taken.kind, NT_REQUEST_STOP);
    assert_int_equal(nt_client_poll(all.other, stop.id, &answer), NT_OK);
    assert_true(answer.pending == 0 && answer.tick == 5 && answer.id == stop.id);
    assert_int_equal(nt_client_poll(all.one, again.id, &answer), NT_OK);
    assert_true(answer.pending == 0 && answer.tick == 5);
    taken = serve(all.frames, 6, NT_OK, 0);
    assert_int_equal(taken.kind, GAIN);
    assert_int_equal(nt_frames_take(all.frames, &taken), 0);
    close_ends(&all);
}

static void the_lease_can_be_given_back(void **state)
{
    (void)state;
    ends all = open_ends();
    nt_request request = gain_of(1.0), taken;
    nt_answer answer;
    assert_int_equal(nt_client_lease(all.one), NT_OK);
    assert_int_equal(nt_client_post(all.one, &request), NT_OK);
    nt_client_release(all.one);
    assert_int_equal(nt_client_post(all.one, &request), NT_E_STATE);
    assert_int_equal(nt_client_lease(all.other), NT_OK);
    assert_int_equal(nt_frames_take(all.frames, &taken), 0); /* what the former holder asked for is void */
    assert_int_equal(nt_client_poll(all.one, request.id, &answer), NT_E_STATE);
    nt_request other = gain_of(2.0);
    assert_int_equal(nt_client_post(all.other, &other), NT_OK);
    assert_true(other.id != request.id);
    assert_true(serve(all.frames, 1, NT_OK, 0).value[0] == 2.0);
    nt_client_close(all.other); /* closing gives it back */
    all.other = NULL;
    assert_int_equal(nt_client_lease(all.one), NT_OK);
    close_ends(&all);
}

static void a_lease_that_is_not_renewed_ends(void **state)
{
    (void)state;
    ends all = open_ends();
    nt_request request = gain_of(1.0);
    assert_int_equal(nt_client_lease(all.one), NT_OK);
    sleep_for(1.01 * NT_LEASE_TERM);
    assert_int_equal(nt_client_lease(all.one), NT_OK); /* nobody wanted it: renewed */
    assert_int_equal(nt_client_post(all.one, &request), NT_OK);
    sleep_for(1.01 * NT_LEASE_TERM);
    assert_int_equal(nt_client_lease(all.other), NT_OK);
    assert_int_equal(nt_client_post(all.one, &request), NT_E_STATE);
    assert_int_equal(nt_client_lease(all.one), NT_E_STATE);
    assert_int_equal(nt_client_post(all.other, &request), NT_OK);
    close_ends(&all);
}

static void a_full_queue_refuses_and_goes_on(void **state)
{
    (void)state;
    ends all = open_ends();
    nt_request request;
    nt_answer answer;
    uint64_t ids[3 * NT_REQUESTS];
    assert_int_equal(nt_client_lease(all.one), NT_OK);
    for (unsigned i = 0; i < 3 * NT_REQUESTS; ++i) {
        request = gain_of(i);
        if (i >= NT_REQUESTS) {
            assert_int_equal(nt_client_post(all.one, &request), NT_E_CAPACITY);
            assert_true(serve(all.frames, i, NT_OK, 0).value[0] == (double)(i - NT_REQUESTS));
        }
        assert_int_equal(nt_client_post(all.one, &request), NT_OK);
        ids[i] = request.id;
    }
    assert_int_equal(nt_client_poll(all.one, ids[2 * NT_REQUESTS - 1], &answer), NT_OK);
    assert_true(answer.tick == 3 * NT_REQUESTS - 1 && !answer.pending);
    assert_int_equal(nt_client_poll(all.one, ids[0], &answer), NT_E_STATE); /* no longer kept */
    assert_int_equal(nt_client_poll(all.one, ids[3 * NT_REQUESTS - 1], &answer), NT_OK);
    assert_int_equal(answer.pending, 1);
    close_ends(&all);
}

/* A late answer to a former holder does not stand in the place of a new one's. */
static void late_answers_displace_nothing(void **state)
{
    (void)state;
    ends all = open_ends();
    nt_request old = gain_of(1.0), fresh = gain_of(2.0);
    nt_answer answer;
    assert_int_equal(nt_client_lease(all.one), NT_OK);
    assert_int_equal(nt_client_post(all.one, &old), NT_OK);
    serve(all.frames, 1, NT_OK, 1);
    nt_client_release(all.one);
    assert_int_equal(nt_client_lease(all.other), NT_OK);
    assert_int_equal(nt_client_post(all.other, &fresh), NT_OK);
    serve(all.frames, 2, NT_OK, 0);
    nt_frames_answer(all.frames, &(nt_answer){.id = old.id, .tick = 3});
    assert_int_equal(nt_client_poll(all.other, fresh.id, &answer), NT_OK);
    assert_int_equal(answer.tick, 2);
    assert_int_equal(nt_client_poll(all.one, old.id, &answer), NT_E_STATE);
    close_ends(&all);
}

/* In another process: posts a request and is killed with the lease in its hands. */
static void a_dead_client_blocks_nobody(void **state)
{
    (void)state;
    char name[NT_NAME_SIZE], byte;
    int ready[2];
    nt_frames *frames = NULL;
    nt_client *client = NULL;
    nt_request request = gain_of(4.0);
    assert_int_equal(nt_frames_create(&frames, session_name(name, 0)), NT_OK);
    assert_int_equal(pipe(ready), 0);
    const pid_t child = fork();
    if (child == 0) {
        if (nt_client_attach(&client, name) != NT_OK || nt_client_lease(client) != NT_OK ||
            nt_client_post(client, &request) != NT_OK || write(ready[1], "", 1) != 1)
            _exit(1);
        for (;;)
            pause();
    }
    assert_int_equal(read(ready[0], &byte, 1), 1);
    kill(child, SIGKILL);
    assert_int_equal(waitpid(child, NULL, 0), child);
    assert_true(serve(frames, 1, NT_OK, 0).value[0] == 4.0);
    assert_int_equal(nt_client_attach(&client, name), NT_OK);
    nt_request stop = {.kind = NT_REQUEST_STOP};
    assert_int_equal(nt_client_post(client, &stop), NT_OK);
    sleep_for(1.01 * NT_LEASE_TERM);
    assert_int_equal(nt_client_lease(client), NT_OK);
    assert_int_equal(nt_client_post(client, &request), NT_OK);
    nt_frames_close(frames);
    nt_answer answer;
    assert_int_equal(nt_client_poll(client, request.id, &answer), NT_E_DEVICE);
    assert_int_equal(nt_client_poll(client, stop.id, &answer), NT_E_DEVICE);
    nt_client_close(client);
    close(ready[0]);
    close(ready[1]);
}

static uint64_t random_word(uint64_t *seed)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return *seed ^ *seed >> 29;
}

/* Random words over the whole block, and words that look nearly right. */
static void scribble(nt_commands_block *block, uint64_t *seed)
{
    nt_word *words = (nt_word *)(void *)block;
    const size_t count = sizeof *block / sizeof *words;
    for (int i = 0; i < 200; ++i) {
        const uint64_t value = random_word(seed);
        atomic_store_explicit(&words[random_word(seed) % count], value % 3 ? value : value % 8, memory_order_relaxed);
    }
    nt_request_slot *slot = &block->slots[1 + random_word(seed) % 4];
    const uint64_t epoch = atomic_load_explicit(&block->lease, memory_order_relaxed) >> NT_DEADLINE_BITS;
    atomic_store(&slot->id, (epoch << NT_TICKET_BITS) + 1 + random_word(seed) % 4);
}

/* Each call of the writer ends, what it takes bears its check word, and when the scribbler has gone a client gets
 * through. */
static void a_client_that_scribbles_harms_nothing(void **state)
{
    (void)state;
    ends all = open_ends();
    nt_request request;
    uint64_t seed = 12345, stops = 0;
    for (int i = 0; i < 20000; ++i) {
        scribble(all.frames->commands, &seed);
        for (int j = 0; j < 3; ++j) {
            const int took = nt_frames_take(all.frames, &request);
            assert_true(took == 0 || took == 1);
            assert_true(!took || request.kind == NT_REQUEST_STOP); /* the one word that needs no check */
            stops += (uint64_t)took;
        }
    }
    assert_true(stops > 0);
    while (nt_frames_take(all.frames, &request))
        ;
    sleep_for(1.01 * NT_LEASE_TERM); /* the word may by chance look like a lease */
    assert_int_equal(nt_client_lease(all.one), NT_OK);
    request = gain_of(8.0);
    assert_int_equal(nt_client_post(all.one, &request), NT_OK);
    assert_true(serve(all.frames, 9, NT_OK, 0).value[0] == 8.0);
    nt_answer answer;
    assert_int_equal(nt_client_poll(all.one, request.id, &answer), NT_OK);
    assert_int_equal(answer.tick, 9);
    close_ends(&all);
}

/* The same while it scribbles, from a process of its own, until it is killed. */
static void a_scribbling_process_harms_nothing(void **state)
{
    (void)state;
    char name[NT_NAME_SIZE], byte;
    int ready[2];
    nt_frames *frames = NULL;
    nt_request request;
    assert_int_equal(nt_frames_create(&frames, session_name(name, 1)), NT_OK);
    assert_int_equal(pipe(ready), 0);
    const pid_t child = fork();
    if (child == 0) {
        uint64_t seed = 777;
        for (long i = 0;; ++i) {
            scribble(frames->commands, &seed);
            if (i == 10 && write(ready[1], "", 1) != 1)
                _exit(1);
        }
    }
    assert_int_equal(read(ready[0], &byte, 1), 1);
    for (uint64_t tick = 0; tick < 300000; ++tick) {
        publish(frames, tick, tick + 1);
        assert_true(!nt_frames_take(frames, &request) || request.kind == NT_REQUEST_STOP);
    }
    kill(child, SIGKILL);
    assert_int_equal(waitpid(child, NULL, 0), child);
    nt_frames_close(frames);
    close(ready[0]);
    close(ready[1]);
}

enum { POSTS = 20000 };

static void *post_many(void *context)
{
    nt_client *client = context;
    for (int i = 0; i < POSTS;) {
        nt_request request = gain_of(i);
        const nt_status status = nt_client_post(client, &request);
        if (status == NT_OK)
            ++i;
        else if (status == NT_E_CAPACITY)
            sched_yield();
        else if (nt_client_lease(client) != NT_OK) /* this thread slept through the term: it is still nobody's */
            return client;
    }
    return NULL;
}

static void threads_lose_no_request(void **state)
{
    (void)state;
    ends all = open_ends();
    pthread_t client;
    nt_request request;
    int wrong = 0;
    assert_int_equal(nt_client_lease(all.one), NT_OK);
    assert_int_equal(pthread_create(&client, NULL, post_many, all.one), 0);
    for (int i = 0; i < POSTS;) {
        if (!nt_frames_take(all.frames, &request)) {
            sched_yield();
            continue;
        }
        wrong += request.kind != GAIN || request.value[0] != (double)i || request.value[1] != -(double)i;
        nt_frames_answer(all.frames, &(nt_answer){.id = request.id, .tick = (uint64_t)i});
        ++i;
    }
    void *failed = NULL;
    pthread_join(client, &failed);
    assert_null(failed);
    assert_int_equal(wrong, 0);
    close_ends(&all);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_request_is_taken_and_answered),    cmocka_unit_test(without_the_lease_only_a_stop_passes),
        cmocka_unit_test(the_lease_can_be_given_back),        cmocka_unit_test(a_lease_that_is_not_renewed_ends),
        cmocka_unit_test(a_full_queue_refuses_and_goes_on),   cmocka_unit_test(late_answers_displace_nothing),
        cmocka_unit_test(a_dead_client_blocks_nobody),        cmocka_unit_test(a_client_that_scribbles_harms_nothing),
        cmocka_unit_test(a_scribbling_process_harms_nothing), cmocka_unit_test(threads_lose_no_request),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
