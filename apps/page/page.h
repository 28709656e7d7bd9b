/* SPDX-License-Identifier: BSD-3-Clause
 * What the page asks of the library: flat functions on one scene, one plan to draw and one session, so that JavaScript
 * needs no layout of a struct. Public headers only. The same files are compiled natively for the test that compares the
 * two. Nothing here is thread-safe: a worker has a module of its own. */
#ifndef NANOTOUCH_PAGE_H
#define NANOTOUCH_PAGE_H

#include <stdint.h>

#include "nanotouch/advanced/view.h"
#include "nanotouch/nanotouch.h"

#if defined(__wasm__)
#define PAGE_API(name) __attribute__((export_name(#name)))
#else
#define PAGE_API(name)
#endif

/* What is described, as an argument. */
enum { PAGE_SCENE, PAGE_RIG, PAGE_SETTINGS, PAGE_KINDS };

/* What one update holds: 128 bytes, little-endian, the same over a socket. Forces on the tip, least and largest of all
 * ticks since the last update, so that no spike is lost. */
typedef struct page_update {
    uint8_t version, state, phase, events; /* PAGE_VERSION; nt_state; nt_phase; PAGE_SNAP | PAGE_TEAR */
    uint32_t reasons;                      /* NT_REASON_* */
    uint32_t changes;                      /* of the world */
    uint32_t ticks;                        /* that this update sums up */
    uint64_t sequence;                     /* number of the newest tick */
    double time;                           /* [s] */
    double tip[3];                         /* of the apex [m] */
    double gap;                            /* [m] */
    double force;                          /* z [N] */
    float side[2];                         /* force x, y [N] */
    float least, largest;                  /* force z [N] */
    float base, deflection;                /* [m] */
    float contact, cohesive, neck;         /* radii [m] */
    float motor;                           /* what the hand feels, z [N] */
    float master[3];                       /* [m] */
    uint32_t reserved;
} page_update;
enum { PAGE_VERSION = 1, PAGE_SNAP = 1, PAGE_TEAR = 2 };

/* The scene that the page works on (page.c), for page_session.c. */
typedef struct page_world {
    nt_scene scene;
    nt_rig rig;
    nt_settings settings;
    nt_demand demand;
    nt_problem problem;
    nt_plan plan;
} page_world;
page_world *page_the_world(void);

/* Numbers of an open: where it starts and how the map lies. */
typedef struct page_opening {
    double x, y, clearance, rise; /* [m] */
    double dx, dy;                /* of a pixel [m] */
    double seed, margin;          /* the least one that is opened with */
} page_opening;

/* page.c */
void *page_alloc(uint32_t bytes);
void page_free(void *memory);
int page_field_count(int kind);
const char *page_field_text(int kind, int number, int part);
double page_field_minimum(int kind, int number);
double page_field_maximum(int kind, int number);
double page_get(int kind, int number);
void page_set(int kind, int number, double value);
void page_defaults(void);
void page_accuracy(double relative);
int page_check(int kind);
const char *page_problem(int status);
int page_plan(void);
const char *page_fact_name(int number);
double page_fact(int number);
int page_term_count(void);
const char *page_term_text(int number, int part);
double page_term_value(int number, int part);
int page_warning_count(void);
const char *page_warning(int number);
double page_cutoff_gap(double force);
int page_curve(int part, double nearest, double farthest, nt_view_point *rows, int count);
void page_section(const double pose[2], const double *r, nt_view_profile *rows, int count, double found[3]);
int page_dots(double *heights, int pixels, double size);

/* page_session.c */
int page_open(const double *heights, int nx, int ny, const page_opening *opening);
void page_close(void);
int page_run(int ticks);
const page_update *page_update_of(void);
void page_taken(void);
int page_push(double force, double x, double y, double duration);
void page_stop(void);
int page_arm(void);
void page_changed(void);
int page_rewind(double duration);
int page_properties(const double *youngs_modulus, const double *work_of_adhesion, int nx, int ny);
void page_place(double x, double y, double found[4]);

nt_session *page_the_session(void);

/* page_particles.c */
int page_particles(const double *values, int count);
int page_rod(const double *values, int count);
const nt_particles *page_given_particles(void);
const nt_rod *page_given_rod(void);

/* page_host.c */
int page_compose(const double ground[5]);
double page_clearance(void);
void page_host_lay(const char *const texts[4], const double size[2], int pushed);
int page_host_open(void);
void page_host_see(const nt_frame *frame);
void page_host_follow(double elapsed);
int page_host_ask(const char *what, const char *text, const double values[3]);
void page_host_refuse(const char *why);
const char *page_host_tell(void);
const char *page_host_result(int begin);
const char *page_host_wants(void);
const char *page_host_reopens(void);
double page_host_reopens_to(void);
void page_host_state(double found[6]);
const char *page_host_facts(void);
const char *page_host_task(void);
int page_host_solve(void);

/* page_dented.c */
enum { PAGE_DENT = 8 }; /* numbers of each dent */
void page_dented_begin(double load);
int page_dented_lay(const double *heights, int nx, int ny, double dx, double dy);
void page_dented_take(const double *rows, int count);
void page_dented_follow(const double *rows, int count, int anew);
double page_dented_fact(int what);
int page_dented_curve(int part, double farthest, nt_view_point *rows, int count);
void page_dented_section(double gap, const double *r, nt_view_profile *rows, int count, double found[3]);
int page_dented_heights(double *heights);

/* page_curve.c */
int page_read_curve(const double *z, const double *force, int in_count, int out_count, double spring_constant);
const char *page_reading_name(int number);
double page_reading(int number);
int page_branch(int retract, const double **z, const double **force);
double page_hertz(double radius, double spring_constant);

/* Sums up a run of ticks in *update: forward from the last one. */
void page_sum_up(page_update *update, const nt_frame *frame);

#endif
