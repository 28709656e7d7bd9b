/* SPDX-License-Identifier: BSD-3-Clause
 * Lease, ids and answers as words: the epoch, until when it holds, what counts as scribbled, when places are free. */
#include "frames_fixture.h"

#include <math.h>

#include "hal/clock.h"
#include "session/frames_memory.h"

#define EPOCH ((uint64_t)1 << 41)
#define TICKET ((uint64_t)1 << 40)
#define EPOCHS ((uint64_t)1 << 23)
enum { TERM = 1000 }; /* NT_LEASE_TERM [ms] */

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
    nt_frames_beat(made.frames);
    return made;
}

static void close_ends(ends *all)
{
    nt_client_close(all->one);
    nt_client_close(all->other);
    nt_frames_close(all->frames);
}

static uint64_t milliseconds(void)
{
    return (uint64_t)nt_clock_now() / 1000000u;
}

static uint64_t lease_of(const ends *all)
{
    return nt_word_of(&all->frames->commands->lease);
}

static void a_lease_is_epoch_and_deadline(void **state)
{
    (void)state;
    ends all = open_ends();
    const uint64_t before = milliseconds();
    assert_int_equal(nt_client_lease(all.one), NT_OK);
    const uint64_t after = milliseconds(), until = lease_of(&all) % EPOCH;
    assert_true(lease_of(&all) / EPOCH == 1 && until >= before + TERM && until <= after + TERM);
    assert_int_equal(nt_client_lease(all.other), NT_E_STATE);
    assert_int_equal(nt_client_lease(all.one), NT_OK); /* renewed, of the same epoch */
    assert_true(lease_of(&all) / EPOCH == 1);
    nt_client_release(all.one);
    assert_true(lease_of(&all) == EPOCH); /* free at once */
    nt_client_release(all.one);
    assert_int_equal(nt_client_lease(all.other), NT_OK);
    assert_true(lease_of(&all) / EPOCH == 2);
    nt_client_release(all.one); /* that is not its own */
    assert_true(lease_of(&all) / EPOCH == 2 && lease_of(&all) % EPOCH > before);
    close_ends(&all);
}

/* One that has ended is taken, and one that is later than any may be, too. */
static void what_is_no_lease_is_taken(void **state)
{
    (void)state;
    const struct {
        int64_t from_now;
        nt_status status;
    } cases[] = {{-2, NT_OK}, {0, NT_OK}, {500, NT_E_STATE}, {TERM, NT_E_STATE}, {TERM + 500, NT_OK}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        ends all = open_ends();
        const uint64_t lease = 5 * EPOCH + (uint64_t)((int64_t)milliseconds() + cases[i].from_now);
        atomic_store(&all.frames->commands->lease, lease);
        assert_int_equal(nt_client_lease(all.one), cases[i].status);
        assert_true(cases[i].status == NT_OK ? lease_of(&all) / EPOCH == 6 : lease_of(&all) == lease);
        close_ends(&all);
    }
    ends all = open_ends();
    atomic_store(&all.frames->commands->lease, (EPOCHS - 1) * EPOCH); /* the last one: they begin anew, with 1 */
    assert_int_equal(nt_client_lease(all.one), NT_OK);
    assert_true(lease_of(&all) / EPOCH == 1);
    atomic_store(&all.frames->commands->lease, (EPOCHS - 2) * EPOCH);
    assert_int_equal(nt_client_lease(all.one), NT_OK);
    assert_true(lease_of(&all) / EPOCH == EPOCHS - 1);
    atomic_store(&all.frames->block->beat, 0); /* closed */
    nt_request request = {.kind = 7};
    assert_int_equal(nt_client_lease(all.one), NT_E_DEVICE);
    assert_int_equal(nt_client_post(all.one, &request), NT_E_DEVICE);
    close_ends(&all);
}

static void answer(nt_frames *frames, uint64_t id, uint32_t pending)
{
    const nt_answer given = {.id = id, .status = NT_OK, .pending = pending};
    nt_frames_answer(frames, &given);
}

/* Numbered from 1 in each epoch; a place is free once its last request has been answered for good. */
static void ids_and_their_places(void **state)
{
    (void)state;
    ends all = open_ends();
    nt_request request = {.kind = 7}, taken;
    assert_int_equal(nt_client_post(all.one, &request), NT_E_STATE); /* without a lease */
    nt_client_lease(all.one);
    for (uint64_t i = 1; i <= NT_REQUESTS; ++i) {
        assert_int_equal(nt_client_post(all.one, &request), NT_OK);
        assert_true(request.id == TICKET + i);
        assert_int_equal(nt_frames_take(all.frames, &taken), 1);
        assert_true(taken.id == request.id && all.frames->ticket == i);
    }
    assert_int_equal(nt_client_post(all.one, &request), NT_E_CAPACITY);
    answer(all.frames, TICKET + 2, 0);
    assert_int_equal(nt_client_post(all.one, &request), NT_E_CAPACITY); /* it is the first one's turn */
    answer(all.frames, TICKET + 1, 1);
    assert_int_equal(nt_client_post(all.one, &request), NT_E_CAPACITY);
    answer(all.frames, TICKET + 1, 0);
    assert_int_equal(nt_client_post(all.one, &request), NT_OK);
    assert_true(request.id == TICKET + NT_REQUESTS + 1);
    nt_answer found;
    assert_int_equal(nt_client_poll(all.one, TICKET + 1, &found), NT_OK); /* still there: the next has no answer yet */
    assert_true(found.id == TICKET + 1 && !found.pending);
    assert_int_equal(nt_frames_take(all.frames, &taken), 1);
    answer(all.frames, TICKET + 1, 0); /* of the one before: nobody waits for it */
    answer(all.frames, taken.id, 0);
    assert_int_equal(nt_client_poll(all.one, TICKET + 1, &found), NT_E_STATE); /* too old */
    assert_int_equal(nt_client_poll(all.one, taken.id, &found), NT_OK);
    assert_int_equal(nt_client_poll(all.one, TICKET + 3, &found), NT_OK); /* taken, not answered */
    assert_true(found.pending == 1 && found.id == TICKET + 3);
    assert_int_equal(nt_client_poll(all.one, 2 * TICKET + 3, &found), NT_E_STATE); /* of another epoch */
    nt_client_release(all.one);
    nt_client_lease(all.one);
    assert_int_equal(nt_client_post(all.one, &request), NT_OK);
    assert_true(request.id == 2 * TICKET + 1);
    assert_int_equal(nt_frames_take(all.frames, &taken), 1);
    assert_true(taken.id == request.id && all.frames->epoch == 2 && all.frames->ticket == 1);
    close_ends(&all);
}

/* What does not add up is refused by its id, and taken once. */
static void a_scribbled_request_is_refused(void **state)
{
    (void)state;
    ends all = open_ends();
    nt_client_lease(all.one);
    for (int i = 0; i < 2; ++i) {
        nt_request request = {.kind = 7}, taken;
        assert_int_equal(nt_client_post(all.one, &request), NT_OK);
        nt_request_slot *slot = &all.frames->commands->slots[request.id % NT_REQUESTS];
        if (i == 0)
            atomic_store(&slot->check, nt_word_of(&slot->check) + 1);
        nt_answer found;
        assert_int_equal(nt_frames_take(all.frames, &taken), i);
        assert_true(nt_word_of(&slot->id) == 0);
        assert_int_equal(nt_client_poll(all.one, request.id, &found), NT_OK);
        assert_true(i == 0 ? found.status == NT_E_ARGUMENT && !found.pending : found.pending == 1);
    }
    close_ends(&all);
}

static void stops_are_counted(void **state)
{
    (void)state;
    ends all = open_ends();
    nt_request first = {.kind = NT_REQUEST_STOP}, second = first, taken;
    assert_int_equal(nt_client_post(all.one, &first), NT_OK); /* nobody needs a lease for it */
    assert_int_equal(nt_client_post(all.other, &second), NT_OK);
    assert_true(first.id == (NT_STOP_BIT | 1) && second.id == (NT_STOP_BIT | 2));
    nt_answer found;
    assert_int_equal(nt_client_poll(all.one, first.id, &found), NT_OK);
    assert_true(found.pending == 1);
    assert_int_equal(nt_frames_take(all.frames, &taken), 1);
    assert_true(taken.id == second.id && taken.kind == NT_REQUEST_STOP); /* for both */
    assert_int_equal(nt_frames_take(all.frames, &taken), 0);
    answer(all.frames, second.id, 0);
    for (int i = 0; i < 2; ++i) {
        const uint64_t id = i ? second.id : first.id;
        assert_int_equal(nt_client_poll(all.one, id, &found), NT_OK);
        assert_true(found.id == id && !found.pending);
    }
    assert_int_equal(nt_client_poll(all.one, NT_STOP_BIT | 3, &found), NT_OK);
    assert_true(found.pending == 1);
    close_ends(&all);
}

/* A writer that has been silent for a second is dead. */
static void silence(void **state)
{
    (void)state;
    ends all = open_ends();
    nt_answer found;
    assert_true(nt_frames_silence(all.frames->block) < 0.5);
    const uint64_t now = (uint64_t)nt_clock_now();
    atomic_store(&all.frames->block->beat, now - 700000000u);
    const double quiet = nt_frames_silence(all.frames->block), since = 1e-9 * (double)((uint64_t)nt_clock_now() - now);
    assert_true(quiet >= 0.7 && quiet <= 0.7 + since + 1e-9);
    assert_int_equal(nt_client_poll(all.one, NT_STOP_BIT | 1, &found), NT_OK);
    atomic_store(&all.frames->block->beat, now - 1100000000u);
    assert_int_equal(nt_client_poll(all.one, NT_STOP_BIT | 1, &found), NT_E_DEVICE);
    atomic_store(&all.frames->block->beat, 0);
    assert_true(isinf(nt_frames_silence(all.frames->block)));
    close_ends(&all);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lease_is_epoch_and_deadline),
        cmocka_unit_test(what_is_no_lease_is_taken),
        cmocka_unit_test(ids_and_their_places),
        cmocka_unit_test(a_scribbled_request_is_refused),
        cmocka_unit_test(stops_are_counted),
        cmocka_unit_test(silence),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
