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

/* What nt_x_check() found wrong with a description: the first offending field, its value and its valid range. */
typedef struct nt_problem {
    const char *field;       /* dotted name, "tip.radius"; static storage */
    const char *unit;        /* SI unit of value, minimum, maximum; "" if none */
    double value;            /* the value found [unit of the field] */
    double minimum, maximum; /* the valid range, both ends included [unit of the field] */
} nt_problem;

/* The unit of a problem that is no value out of range but a reason in words, its field: `value` is then the error that
 * there would be (infinite: not known), `maximum` the one demanded. */
#define NT_UNIT_ERROR "error"
/* The unit of a problem that is nothing but a reason in words, its field. */
#define NT_UNIT_REASON "reason"

/* Writes "tip.radius = 20 m: valid is 1e-10 .. 0.001 m" into text (always ended by 0 when size > 0).
 * Returns text. */
NT_API const char *nt_problem_print(const nt_problem *problem, char *text, unsigned size);

#ifdef __cplusplus
}
#endif
#endif
