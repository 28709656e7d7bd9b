/* SPDX-License-Identifier: BSD-3-Clause
 * Requests and answers. A request lies where its id says, so that writer and client need no common counter: the writer
 * looks into one slot per call, whatever the others hold. */
#include "nanotouch/frames.h"

#include <stdlib.h>

#include "hal/clock.h"
#include "nanotouch/advanced/observer.h"
#include "session/frames_memory.h"

static const uint64_t one_ticket = (uint64_t)1 << NT_TICKET_BITS;
static const uint64_t one_epoch = (uint64_t)1 << NT_DEADLINE_BITS;
static const uint64_t epochs = (uint64_t)1 << (64 - NT_DEADLINE_BITS);

static uint64_t lease_epoch(const nt_commands_block *commands)
{
    return nt_word_of(&commands->lease) / one_epoch;
}

/* --- the session's side --- */

static int take_stop(nt_frames *frames, nt_request *request)
{
    const uint64_t stops = nt_word_of(&frames->commands->stops);
    if (stops == frames->stops)
        return 0;
    frames->stops = stops;
    *request = (nt_request){.id = NT_STOP_BIT | stops, .kind = NT_REQUEST_STOP};
    return 1;
}

int nt_frames_take(nt_frames *frames, nt_request *request)
{
    if (take_stop(frames, request))
        return 1;
    const uint64_t epoch = lease_epoch(frames->commands);
    if (epoch != frames->epoch) {
        frames->epoch = epoch;
        frames->ticket = 0;
    }
    const uint64_t id = epoch * one_ticket + (frames->ticket + 1) % one_ticket;
    nt_request_slot *slot = &frames->commands->slots[id % NT_REQUESTS];
    if (atomic_load_explicit(&slot->id, memory_order_acquire) != id)
        return 0;
    nt_request found;
    nt_slot_read(&slot->id, slot->words, &found, NT_WORDS(nt_request));
    const uint64_t check = nt_word_of(&slot->check);
    atomic_store_explicit(&slot->id, 0, memory_order_relaxed); /* taken: never again */
    ++frames->ticket;
    frames->asking[id % NT_REQUESTS] = id;
    if (found.id == id && nt_request_check(&found) == check) {
        *request = found;
        return 1;
    }
    const nt_answer refusal = {.id = id, .status = NT_E_ARGUMENT};
    nt_frames_answer(frames, &refusal);
    return 0;
}

void nt_frames_answer(nt_frames *frames, const nt_answer *answer)
{
    const int is_stop = (answer->id & NT_STOP_BIT) != 0;
    const uint64_t place = is_stop ? NT_REQUESTS : answer->id % NT_REQUESTS;
    if (!is_stop && frames->asking[place] != answer->id)
        return;
    nt_answer_slot *slot = &frames->block->answers[place];
    nt_slot_write(&slot->stamp, slot->words, ++frames->answered, answer, NT_WORDS(nt_answer));
}

/* --- the client's side --- */

struct nt_client {
    nt_shared frames_memory, commands_memory; /* none where they are those of this process */
    const nt_frames_block *block;
    nt_commands_block *commands;
    uint64_t epoch;  /* of its lease; 0: none */
    uint64_t ticket; /* of the request posted last */
};

static nt_status attach_commands(nt_client *client, const char *name)
{
    nt_status status = nt_frames_attach(&client->frames_memory, &client->block, name);
    if (status == NT_OK)
        status = nt_shared_attach(&client->commands_memory, "commands", name, sizeof(nt_commands_block), 1);
    client->commands = client->commands_memory.memory;
    if (status == NT_OK && nt_word_of(&client->commands->token) != nt_word_of(&client->block->token))
        status = NT_E_DEVICE; /* of two sessions, one of which has just gone */
    return status;
}

nt_status nt_client_attach(nt_client **client, const char *name)
{
    if (!client || !name)
        return NT_E_ARGUMENT;
    nt_client *made = calloc(1, sizeof *made);
    if (!made)
        return NT_E_NO_MEMORY;
    made->frames_memory.file = made->commands_memory.file = -1;
    const nt_status status = attach_commands(made, name);
    if (status == NT_OK)
        *client = made;
    else
        nt_client_close(made);
    return status;
}

nt_status nt_client_of(nt_client **client, nt_frames *frames)
{
    if (!client || !frames)
        return NT_E_ARGUMENT;
    nt_client *made = calloc(1, sizeof *made);
    if (!made)
        return NT_E_NO_MEMORY;
    made->frames_memory.file = made->commands_memory.file = -1;
    made->block = frames->block;
    made->commands = frames->commands;
    *client = made;
    return NT_OK;
}

void nt_client_close(nt_client *client)
{
    if (!client)
        return;
    nt_client_release(client);
    nt_shared_close(&client->frames_memory);
    nt_shared_close(&client->commands_memory);
    free(client);
}

static int holds_lease(const nt_client *client)
{
    return client->epoch && lease_epoch(client->commands) == client->epoch;
}

nt_status nt_client_lease(nt_client *client)
{
    if (nt_word_of(&client->block->beat) == 0)
        return NT_E_DEVICE; /* closed */
    const uint64_t term = (uint64_t)(1e3 * NT_LEASE_TERM), now = (uint64_t)nt_clock_now() / 1000000u;
    uint64_t lease = nt_word_of(&client->commands->lease);
    uint64_t epoch = lease / one_epoch;
    const uint64_t until = lease % one_epoch;
    if (!client->epoch || client->epoch != epoch) { /* not ours */
        client->epoch = 0;
        if (until > now && until <= now + term) /* a later one is scribbled */
            return NT_E_STATE;
        epoch = epoch % (epochs - 1) + 1; /* 1 .. epochs - 1 */
    }
    if (!atomic_compare_exchange_strong(&client->commands->lease, &lease, epoch * one_epoch + now + term)) {
        client->epoch = 0;
        return NT_E_STATE; /* another one was faster */
    }
    if (client->epoch != epoch)
        client->ticket = 0;
    client->epoch = epoch;
    return NT_OK;
}

void nt_client_release(nt_client *client)
{
    if (!client->epoch)
        return;
    uint64_t lease = nt_word_of(&client->commands->lease);
    if (lease / one_epoch == client->epoch)
        atomic_compare_exchange_strong(&client->commands->lease, &lease, client->epoch * one_epoch);
    client->epoch = 0;
}

/* The answer that lies in the place of an id; its id is 0 if there is none. */
static nt_answer answer_at(const nt_client *client, uint64_t place)
{
    const nt_answer_slot *slot = &client->block->answers[place];
    nt_answer answer;
    for (int i = 0; i < 8; ++i)
        if (nt_slot_read(&slot->stamp, slot->words, &answer, NT_WORDS(nt_answer)) != 0)
            return answer;
    return (nt_answer){.id = 0};
}

static void write_request(nt_request_slot *slot, const nt_request *request)
{
    atomic_store_explicit(&slot->check, nt_request_check(request), memory_order_relaxed);
    nt_slot_write(&slot->id, slot->words, request->id, request, NT_WORDS(nt_request));
}

nt_status nt_client_post(nt_client *client, nt_request *request)
{
    if (nt_word_of(&client->block->beat) == 0)
        return NT_E_DEVICE; /* closed */
    if (request->kind == NT_REQUEST_STOP) {
        request->id = NT_STOP_BIT | (atomic_fetch_add(&client->commands->stops, 1) + 1);
        return NT_OK;
    }
    if (!holds_lease(client))
        return NT_E_STATE;
    const uint64_t epoch = client->epoch, id = epoch * one_ticket + client->ticket + 1;
    if (client->ticket >= NT_REQUESTS) {
        const nt_answer before = answer_at(client, id % NT_REQUESTS);
        if (before.id != id - NT_REQUESTS || before.pending)
            return NT_E_CAPACITY;
    }
    if (nt_client_lease(client) != NT_OK || client->epoch != epoch) /* lost meanwhile */
        return NT_E_STATE;
    ++client->ticket;
    request->id = id;
    write_request(&client->commands->slots[id % NT_REQUESTS], request);
    return NT_OK;
}

/* Without an answer there is one to come, or there is not. */
static nt_status await_answer(const nt_client *client, uint64_t id, nt_answer *answer)
{
    if (nt_frames_silence(client->block) >= NT_FRAMES_SILENCE)
        return NT_E_DEVICE;
    *answer = (nt_answer){.id = id, .pending = 1};
    return NT_OK;
}

nt_status nt_client_poll(const nt_client *client, uint64_t id, nt_answer *answer)
{
    const int is_stop = (id & NT_STOP_BIT) != 0;
    nt_answer found = answer_at(client, is_stop ? NT_REQUESTS : id % NT_REQUESTS);
    if (is_stop && (found.id & NT_STOP_BIT) && found.id >= id)
        found.id = id; /* a later stop counts for this one */
    if (found.id == id) {
        *answer = found;
        return NT_OK;
    }
    if (!is_stop && (found.id > id || id / one_ticket != lease_epoch(client->commands)))
        return NT_E_STATE;
    return await_answer(client, id, answer);
}
