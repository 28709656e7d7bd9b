/* SPDX-License-Identifier: BSD-3-Clause */
#define _POSIX_C_SOURCE 200809L
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include <pthread.h>
#include <sched.h>

#include "core/ring.h"

static void capacity_must_be_a_power_of_two(void **state)
{
    (void)state;
    nt_ring ring;
    int memory[8];
    const size_t bad[] = {0, 3, 6, 7};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_int_equal(nt_ring_init(&ring, memory, sizeof(int), bad[i]), NT_E_ARGUMENT);
    assert_int_equal(nt_ring_init(&ring, NULL, sizeof(int), 8), NT_E_ARGUMENT);
    assert_int_equal(nt_ring_init(&ring, memory, 0, 8), NT_E_ARGUMENT);
    for (size_t capacity = 1; capacity <= 8; capacity *= 2)
        assert_int_equal(nt_ring_init(&ring, memory, sizeof(int), capacity), NT_OK);
}

static void a_full_ring_refuses_and_keeps_what_it_has(void **state)
{
    (void)state;
    nt_ring ring;
    int memory[4], out[8];
    assert_int_equal(nt_ring_init(&ring, memory, sizeof(int), 4), NT_OK);
    assert_int_equal(nt_ring_pop(&ring, out, 8), 0);
    for (int i = 0; i < 4; i++)
        assert_int_equal(nt_ring_push(&ring, &i), NT_OK);
    const int more = 99;
    assert_int_equal(nt_ring_push(&ring, &more), NT_E_CAPACITY);
    assert_int_equal(nt_ring_count(&ring), 4);
    assert_int_equal(nt_ring_pop(&ring, out, 8), 4);
    for (int i = 0; i < 4; i++)
        assert_int_equal(out[i], i);
}

/* Nobody sees it before it is added. */
static void an_element_may_be_written_in_place(void **state)
{
    (void)state;
    nt_ring ring;
    int memory[2], out[2];
    assert_int_equal(nt_ring_init(&ring, memory, sizeof(int), 2), NT_OK);
    for (int i = 0; i < 2; i++) {
        int *next = nt_ring_next(&ring);
        assert_ptr_equal(next, &memory[i]);
        *next = 7 + i;
        assert_int_equal(nt_ring_count(&ring), i);
        nt_ring_add(&ring);
    }
    assert_null(nt_ring_next(&ring));
    assert_int_equal(nt_ring_pop(&ring, out, 2), 2);
    assert_true(out[0] == 7 && out[1] == 8);
}

/* The indices run over: from just below the largest size_t. */
static void order_is_kept_round_and_round(void **state)
{
    (void)state;
    nt_ring ring;
    int memory[8], next_in = 0, next_out = 0;
    assert_int_equal(nt_ring_init(&ring, memory, sizeof(int), 8), NT_OK);
    atomic_store(&ring.head, SIZE_MAX - 20);
    atomic_store(&ring.tail, SIZE_MAX - 20);
    for (int round = 0; round < 100; round++) {
        int out[8];
        for (int i = 0; i < 1 + round % 8 && nt_ring_push(&ring, &next_in) == NT_OK; i++)
            next_in++;
        const size_t got = nt_ring_pop(&ring, out, (size_t)(1 + round % 5));
        for (size_t i = 0; i < got; i++)
            assert_int_equal(out[i], next_out++);
        assert_int_equal(nt_ring_count(&ring), (size_t)(next_in - next_out));
    }
    assert_true(next_out > 100);
}

/* A ring that holds many: where the threads share a processor, each fills or empties it before the other has its turn.
 */
enum { MESSAGES = 200000, WORDS = 8, HELD = 1024 };

/* A message that shows when it has been torn: all words alike. */
typedef struct message {
    uint64_t words[WORDS];
} message;

static int is_whole(const message *m)
{
    for (int i = 1; i < WORDS; i++)
        if (m->words[i] != m->words[0])
            return 0;
    return 1;
}

static message message_of(uint64_t number)
{
    message m;
    for (int i = 0; i < WORDS; i++)
        m.words[i] = number;
    return m;
}

static void *fill_ring(void *context)
{
    for (uint64_t i = 0; i < MESSAGES; i++) {
        const message m = message_of(i);
        while (nt_ring_push(context, &m) != NT_OK)
            sched_yield();
    }
    return NULL;
}

static void two_threads_lose_and_tear_nothing(void **state)
{
    (void)state;
    static message memory[HELD];
    nt_ring ring;
    pthread_t producer;
    uint64_t expected = 0;
    int whole = 1, in_order = 1, bounded = 1;
    assert_int_equal(nt_ring_init(&ring, memory, sizeof(message), HELD), NT_OK);
    assert_int_equal(pthread_create(&producer, NULL, fill_ring, &ring), 0);
    while (expected < MESSAGES) {
        message got[5];
        bounded &= nt_ring_count(&ring) <= HELD;
        const size_t count = nt_ring_pop(&ring, got, 5);
        if (count == 0)
            sched_yield();
        for (size_t i = 0; i < count; i++) {
            whole &= is_whole(&got[i]);
            in_order &= got[i].words[0] == expected++;
        }
    }
    pthread_join(producer, NULL);
    assert_true(whole && in_order && bounded);
    assert_int_equal(nt_ring_count(&ring), 0);
}

static void only_the_newest_message_counts(void **state)
{
    (void)state;
    nt_mailbox mailbox;
    int memory[3], got = -1;
    nt_mailbox_init(&mailbox, memory, sizeof(int));
    assert_int_equal(nt_mailbox_take(&mailbox, &got), 0);
    assert_int_equal(got, -1);
    for (int i = 0; i < 5; i++)
        nt_mailbox_post(&mailbox, &i);
    assert_int_equal(nt_mailbox_take(&mailbox, &got), 1);
    assert_int_equal(got, 4);
    assert_int_equal(nt_mailbox_take(&mailbox, &got), 0); /* once */
    for (int i = 10; i < 30; i++) {
        nt_mailbox_post(&mailbox, &i);
        assert_int_equal(nt_mailbox_take(&mailbox, &got), 1);
        assert_int_equal(got, i);
    }
}

static void *post_messages(void *context)
{
    for (uint64_t i = 1; i <= MESSAGES; i++) {
        const message m = message_of(i);
        nt_mailbox_post(context, &m);
    }
    return NULL;
}

static void mail_between_threads_is_whole_and_never_goes_back(void **state)
{
    (void)state;
    static message memory[3];
    nt_mailbox mailbox;
    pthread_t sender;
    message got = message_of(0);
    uint64_t last = 0;
    int whole = 1, rising = 1;
    nt_mailbox_init(&mailbox, memory, sizeof(message));
    assert_int_equal(pthread_create(&sender, NULL, post_messages, &mailbox), 0);
    while (last < MESSAGES) { /* the last message must come through */
        if (!nt_mailbox_take(&mailbox, &got)) {
            sched_yield();
            continue;
        }
        whole &= is_whole(&got);
        rising &= got.words[0] > last;
        last = got.words[0];
    }
    pthread_join(sender, NULL);
    assert_true(whole && rising);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(capacity_must_be_a_power_of_two),
        cmocka_unit_test(a_full_ring_refuses_and_keeps_what_it_has),
        cmocka_unit_test(an_element_may_be_written_in_place),
        cmocka_unit_test(order_is_kept_round_and_round),
        cmocka_unit_test(two_threads_lose_and_tear_nothing),
        cmocka_unit_test(only_the_newest_message_counts),
        cmocka_unit_test(mail_between_threads_is_whole_and_never_goes_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
