/* SPDX-License-Identifier: BSD-3-Clause
 * The law of a free cantilever: a line, with a bow, with a squeeze film, with both; private to curves/. */
#ifndef NANOTOUCH_CURVES_FREE_LAW_H
#define NANOTOUCH_CURVES_FREE_LAW_H

#include "curves/bend.h"

enum { NT_FREE_BLOCKS = 120, NT_FREE_BLOCK = 8 }; /* _BLOCK: points, at least */

/* Means of equal blocks, x from the middle of the free approach in halves of its length. What is summed up is over a
 * line of its own, so that lines need not be fitted again. */
typedef struct nt_free_means {
    int count;
    double x[NT_FREE_BLOCKS], rest[NT_FREE_BLOCKS], bow[NT_FREE_BLOCKS]; /* force and x^2 over their lines [N], [1] */
    double line[2], bow_line[2];                                         /* these lines: at x = 0, slope over x */
    double mean, spread;                                                 /* of x; sum of its squares about that */
    double bow_bow, bow_rest, squares;                                   /* sums of products; of rest with itself */
} nt_free_means;

/* The free approach, and what is free of the retraction. */
typedef struct nt_free_record {
    nt_free_means approach, tail; /* count 0: there is no tail */
    double middle, half;          /* of the free approach [m] */
    double foot;                  /* x where contact begins */
} nt_free_record;

/* bow x^2 + film scale/(x - foot + scale), the latter no more than at the foot, over a line. */
typedef struct nt_free_law {
    int has_bow, has_film;
    double bow, film, scale;                        /* [N], [N], of x */
    double bow_variance, covariance, film_variance; /* in variances of a block's mean */
    double film_line[2], film_back[2];              /* line of a film of 1 through the approach, through the tail */
    double squares;                                 /* that it leaves [N^2] */
    int confirmed;                                  /* by the retraction's tail too */
} nt_free_law;

/* Of the points from `first` on, of at least NT_FREE_BLOCK for a block, in the frame of a record. */
nt_free_means nt_free_means_of(const nt_curve_branch *branch, long first, const nt_free_record *frame);
/* Its line and bow, of the free approach or of the tail: [0] + [1] x + [2] x^2 [N]. */
void nt_free_even(const nt_free_law *law, const nt_free_record *record, int of_tail, double even[3]);
/* Its film at x [N]. */
double nt_free_film_at(const nt_free_law *law, const nt_free_record *record, double x);
/* The likeliest law, and what the others leave open. */
nt_free_law nt_free_judge(const nt_free_record *record, nt_curve_bend_doubts *left_open);

#endif
