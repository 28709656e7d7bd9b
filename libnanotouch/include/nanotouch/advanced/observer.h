/* SPDX-License-Identifier: BSD-3-Clause
 * Reads the frames of a running session (frames.h) from its own or another process. Observers map the memory read-only:
 * one that stops, crashes or lags changes nothing for the session. */
#ifndef NANOTOUCH_OBSERVER_H
#define NANOTOUCH_OBSERVER_H

#include "nanotouch/frames.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One thread per observer. */
typedef struct nt_observer nt_observer;

/* Attaches to the session of that name; reading starts with what comes next. NT_E_DEVICE if there is no such session or
 * this user may not read it; NT_E_RANGE for a bad name; NT_E_UNSUPPORTED if another version of the library wrote it;
 * NT_E_NO_MEMORY. The result belongs to the caller: nt_observer_close. */
NT_API nt_status nt_observer_attach(nt_observer **observer, const char *name);
/* Accepts NULL. */
NT_API void nt_observer_close(nt_observer *observer);

/* The newest frame; 0 if there is none yet. Does not change what nt_observer_read gives next. */
NT_API int nt_observer_newest(const nt_observer *observer, nt_frame *frame);
/* Up to `count` frames in their order, each once; returns how many. An observer that has fallen behind by more than the
 * ring goes on half a ring behind the newest frame, and counts the rest as missed. */
NT_API long nt_observer_read(nt_observer *observer, nt_frame *frames, long count);
/* Frames that were overwritten before they were read. */
NT_API uint64_t nt_observer_missed(const nt_observer *observer);

/* How long ago the writer gave a sign of life [s]; infinite once it has closed. */
NT_API double nt_observer_silence(const nt_observer *observer);
/* 1 while that is below NT_FRAMES_SILENCE. */
NT_API int nt_observer_is_alive(const nt_observer *observer);

/* Copies the description, always ended by 0, into text, which has NT_DESCRIPTION_SIZE bytes; changes (may be NULL): its
 * counter, 0 and an empty text before the first one. NT_E_CAPACITY if it changed too often to be read: try again. */
NT_API nt_status nt_observer_description(const nt_observer *observer, char *text, uint32_t *changes);

#ifdef __cplusplus
}
#endif
#endif
