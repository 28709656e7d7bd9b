/* SPDX-License-Identifier: BSD-3-Clause
 * Parts of the host: numbers in words, and the hand's proxy. */
#ifndef NANOTOUCH_INTERNAL_HOST_H
#define NANOTOUCH_INTERNAL_HOST_H

#include "nanotouch/host.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A number of so many digits with its unit under a prefix, "-" where it is not known. Returns text. */
NT_API const char *nt_host_digits(double value, const char *unit, int count, char *text, size_t size);
/* A hand that rests at the start. */
NT_API nt_proxy nt_proxy_begin(const nt_proxy_facts *facts);
/* By lengths at the tip [m], the third one + down; 0 where the force limit has cut it. */
NT_API int nt_proxy_move(nt_proxy *hand, const double way[NT_AXES], const nt_frame *frame);
/* Down by steps of the wheel, longer ones far from the surface; up if below 0. */
NT_API int nt_proxy_wheel(nt_proxy *hand, double steps, const nt_frame *frame);
/* Draws back to the clearance over the surface, and by what adhesion stretches the springs before it lets go. */
NT_API void nt_proxy_lift(nt_proxy *hand, const nt_frame *frame);
/* What an arm does by itself in a time [s]: it presses, gives way, and stays by a stopped tip. */
NT_API void nt_proxy_follow(nt_proxy *hand, const nt_frame *frame, double elapsed);
/* 1 where it moves by itself now. */
NT_API int nt_proxy_acts(const nt_proxy *hand, const nt_frame *frame);
/* Begins anew where master and tip are, as after a rewind. */
NT_API void nt_proxy_resume(nt_proxy *hand, const nt_frame *frame);

#ifdef __cplusplus
}
#endif
#endif
