/* SPDX-License-Identifier: BSD-3-Clause
 * A sample that keeps what a tip does to it while it is touched: force and heat of each contact by the law of
 * plasticity.h, and a list of the dents and grooves that are left.
 *
 * One contact has one memory, chosen where it begins: the dent that is there, or none. A tip that slides ploughs: the
 * rear half of its contact is free, so that it sinks until the front half carries the load, and the groove takes
 * hardness times its section (docs/indentation.md). All functions: thread-safe, no state but the caller's. */
#ifndef NANOTOUCH_DENTS_H
#define NANOTOUCH_DENTS_H

#include "nanotouch/advanced/plasticity.h"
#include "nanotouch/contact.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { NT_DENTS = 128 };

/* What a contact has left. */
typedef struct nt_dent {
    nt_imprint imprint; /* a dent, or a groove: end is not start */
    double load;        /* that makes it at rest [N] */
    int before;         /* the dent of the list that it has grown from; -1: a new one */
    int grown;          /* so often it has grown in its place, as the last of the list */
} nt_dent;

/* Copyable. Zero is a sample that nothing has touched; nt_dents_place comes first. */
typedef struct nt_dents {
    nt_indentation_state contact; /* the one that is, or was last; indentation from where nothing had yielded */
    double bottom;                /* the residual depth where this contact began [m] */
    double began;                 /* and the radius of its dent; 0: none [m] */
    double start[2], at[2];       /* where the contact began to slide, and is [m] */
    double pressed[2];            /* where its dent grew last [m] */
    double ploughed;              /* share of the rear half that is free, 0 .. 1 [-] */
    double slid;                  /* the largest load while it slid, as at rest [N] */
    double dissipated;            /* heat of all contacts, grows only [J] */
    int touches;                  /* 1: it presses ... */
    int inside;                   /* ... in this dent of the list, -1: in none */
    int full;                     /* 1: a dent had no place in the list */
    int count;
    nt_dent made[NT_DENTS];
} nt_dents;

/* A tip that touches nothing goes to (x, y) [m]; what the last contact has left is added to the list. A dent that grows
 * keeps its middle; the last of the list grows in its place, so that a lever that rings makes one dent. Returns how
 * many dents were added or have grown, 0 .. 2: the last of the list. While it touches: nothing. */
NT_API NT_REALTIME int nt_dents_place(const nt_indentation *indentation, nt_dents *dents, double x, double y);
/* The law at a gap [m] over the surface with its dents, as nt_dents_lowered had it when the contact began. U is the
 * work of getting there, with the heat of what yields. Pure. NaN in, NaN out. */
NT_API NT_REALTIME nt_law_value nt_dents_eval(const nt_indentation *indentation, const nt_dents *dents, double gap);
/* Commits a gap; one that is not a number changes nothing. */
NT_API NT_REALTIME void nt_dents_advance(const nt_indentation *indentation, nt_dents *dents, double gap);
/* The tip slips over the sample to (x, y), at the gap that was committed. What the contact gives up is heat. */
NT_API NT_REALTIME void nt_dents_slide(const nt_indentation *indentation, nt_dents *dents, double x, double y);

#ifdef __cplusplus
}
#endif
#endif
