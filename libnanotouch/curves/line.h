/* SPDX-License-Identifier: BSD-3-Clause
 * Lines and waves through the points of a free cantilever; private to curves/. */
#ifndef NANOTOUCH_CURVES_LINE_H
#define NANOTOUCH_CURVES_LINE_H

#include "nanotouch/curves.h"

enum { NT_WAVE_GRID = 1024 }; /* points of the spectrum that a wave is looked for in */

/* The points in the order of time, and room for as many weights, residuals and scratch values. */
typedef struct nt_curve_free {
    double *x, *force; /* from z_mean [m]; [N] */
    double *weight, *rest, *scratch;
    double *room; /* 4 count + NT_WAVE_GRID */
    long count;
    double z_mean;  /* [m] */
    double nearest; /* least z of them, to the last bit [m] */
    double travel;  /* that they cover [m]; of nt_curve_rough_line */
} nt_curve_free;

/* A robust line through a sample of them: iterated least squares with Tukey's weights. */
nt_curve_baseline nt_curve_rough_line(nt_curve_free *free);
/* From there to the line through all of them. Leaves their residuals behind. */
void nt_curve_refine_line(nt_curve_free *free, nt_curve_baseline *line);
/* Both, judged. */
nt_curve_baseline nt_curve_line(nt_curve_free *free);
/* What the residuals say of the noise, and so of level and slope. */
void nt_curve_judge(nt_curve_free *free, nt_curve_baseline *baseline);
/* By how much the residuals' correlation raises the variance of their mean; 1 for white noise. */
double nt_curve_correlation(const nt_curve_free *free, double scatter);

/* Line and wave together; the line where no wave stands out of its residuals, or (unless `asked`) none is evident. */
nt_curve_baseline nt_curve_with_wave(nt_curve_free *free, const nt_curve_baseline *line, int asked);
double nt_curve_wave_at(const nt_curve_wave *wave, double x);

#endif
