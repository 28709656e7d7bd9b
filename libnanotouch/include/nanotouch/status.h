/* SPDX-License-Identifier: BSD-3-Clause
 * What can fail, and how it is said: one list gives codes, messages and the Python exceptions. */
#ifndef NANOTOUCH_STATUS_H
#define NANOTOUCH_STATUS_H

#if defined(_WIN32)
#define NT_API
#elif defined(__GNUC__)
#define NT_API __attribute__((visibility("default")))
#else
#define NT_API
#endif

/* Marks a function that is safe in a real-time loop: bounded time, no lock, no heap, no system call. */
#define NT_REALTIME

#ifdef __cplusplus
extern "C" {
#endif

/* X(code, message) */
#define NT_STATUS_LIST(X)                                                                                              \
    X(NT_OK, "no error")                                                                                               \
    X(NT_E_ARGUMENT, "an argument is NULL, inconsistent or not one of the allowed values")                             \
    X(NT_E_NOT_FINITE, "a value is NaN or infinite")                                                                   \
    X(NT_E_RANGE, "a value is outside its valid range")                                                                \
    X(NT_E_NO_SOLUTION, "the requested branch has no solution there")                                                  \
    X(NT_E_NO_CONVERGENCE, "the solver did not converge")                                                              \
    X(NT_E_CAPACITY, "a fixed-size buffer is full")                                                                    \
    X(NT_E_STATE, "the call is not allowed in this state")                                                             \
    X(NT_E_NO_MEMORY, "out of memory")                                                                                 \
    X(NT_E_DEVICE, "a device is missing or failed")                                                                    \
    X(NT_E_UNSUPPORTED, "this build or system does not support it")

typedef enum nt_status {
#define NT_STATUS_ENUM(code, message) code,
    NT_STATUS_LIST(NT_STATUS_ENUM)
#undef NT_STATUS_ENUM
} nt_status;

/* The message of a status; never NULL, an unknown code gives "unknown status". Thread-safe, real-time safe. */
NT_API const char *nt_status_message(nt_status status);

/* What else is the matter with a value than its range, in words: one row for each, printed by nt_problem_print, and by
 * nobody else. {} stands for the cause. */
#define NT_PROBLEM_LIST(X)                                                                                             \
    X(RANGE, "")                                                                                                       \
    X(ACCURACY, "")                                                                                                    \
    X(BUDGET, "")                                                                                                      \
    X(DEFORMS, "the sample deforms under {} before contact")                                                           \
    X(DEFORMS_BEFORE_SHAPE, "before a sample that deforms")                                                            \
    X(TAIL, "{} alone pulls more than the whole work of adhesion")                                                     \
    X(DEFORMED_TAIL, "{} alone pulls almost as much, or more, once the sample has deformed under it")                  \
    X(JUMPS, "nearer the sample jumps to the tip, pulled by {}, and without adhesion what follows is not planned")     \
    X(SPREAD,                                                                                                          \
      "the soft sample deforms otherwise at the effective radius of some places than at the tip's own, and no "        \
      "one plan spans both; a smoother surface or another tip has less spread")                                        \
    X(TABLE, "the table of a law of its own errs by more, beside what is felt")                                        \
    X(SHAPE_OF_PROPERTIES, "adhesion on a surface with properties")                                                    \
    X(PLASTIC_SAMPLE, "mean pressure above 3 times the yield strength of the sample, where no elastic law holds")      \
    X(PLASTIC_TIP, "mean pressure above 3 times the yield strength of the tip, where no elastic law holds")            \
    X(DENTS_STRENGTH, "of a sample that keeps dents")                                                                  \
    X(DENTS_BESIDE, "beside adhesion or other forces than contact, which a sample that keeps dents does not know")     \
    X(DENTS_SHAPE, "of a layer, a map of properties, or a tip that is not round")                                      \
    X(DENTS_GROOVE, "a groove wider than half of the tip")                                                             \
    X(RELAXES_BESIDE, "beside {}, which a sample that relaxes does not know")                                          \
    X(RELAXES_DEPTH, "where a sample that relaxes is pressed in deeper than its law holds")                            \
    X(FRICTION_SHAPE, "of a cone or punch that adheres; its shear strength will do")                                   \
    X(BOUND_OF_REAL_SLAVE, "a plan whose bound is not known, which no real slave is armed with")                       \
    X(FORCE_TABLE_SURFACE, "a plan over a surface has a force of each place, a table that of a flat")                  \
    X(FORCE_TABLE_DENTS, "a sample that keeps dents has a force of all that was pressed before")                       \
    X(FORCE_TABLE_RELAXES, "a sample that relaxes has a force of all that was pressed before")                         \
    X(FORCE_TABLE_SINGLE, "a force that single precision cannot hold")                                                 \
    X(FORCE_TABLE_FAR, "a force that is felt beyond 1 mm")                                                             \
    X(FORCE_TABLE_PIECES, "it needs more pieces than there is place for")                                              \
    X(FORCE_TABLE_HOLES, "a plan without a force at some gaps of its range")
typedef enum nt_problem_code {
#define NT_PROBLEM_CODE(name, words) NT_PROBLEM_##name,
    NT_PROBLEM_LIST(NT_PROBLEM_CODE)
#undef NT_PROBLEM_CODE
        NT_PROBLEM_CODES
} nt_problem_code;

/* One change that was tried, and with which there is no such problem. */
typedef struct nt_remedy {
    const char *field; /* dotted name; static storage; NULL: none is known */
    const char *unit;  /* SI unit of value */
    double value;      /* [unit of the field] */
} nt_remedy;

/* What is wrong with a description, or cannot be done with it: the first offending field, its value and its valid
 * range. */
typedef struct nt_problem {
    const char *field;       /* dotted name, "tip.radius"; static storage; NULL: no value is, the code says it all */
    const char *unit;        /* SI unit of value, minimum, maximum; "" if none */
    double value;            /* the value found [unit of the field] */
    double minimum, maximum; /* the valid range, both ends included; infinite minimum: none is [unit of the field] */
    nt_problem_code code;    /* NT_PROBLEM_RANGE: there is no more to it */
    const char *cause; /* what causes it, such as the name of a law; static storage; NULL: nothing but the value */
    nt_remedy remedy;
} nt_problem;

enum { NT_PROBLEM_TEXT = 640 }; /* characters that hold every problem in words */
/* Writes "tip.radius = 20 m: valid is 1e-10 .. 0.001 m" into text (always ended by 0 when size > 0), with the words of
 * the code and the remedy; NT_PROBLEM_TEXT characters hold every one. Returns text. */
NT_API const char *nt_problem_print(const nt_problem *problem, char *text, unsigned size);

#ifdef __cplusplus
}
#endif
#endif
