// SPDX-License-Identifier: BSD-3-Clause
// Laws as numpy's own functions: numpy broadcasts, converts, allocates, masks and hands on to other libraries' arrays.
#pragma once
#include <cfenv>
#include <cstring>
#include <functional>

#include "chapters.h"

// What numpy calls: pointers to inputs and outputs, the count, the strides in bytes, and what the ufunc was made with.
using UfuncLoop = void (*)(char **, const py::ssize_t *, const py::ssize_t *, void *);

// A ufunc of doubles. `data` has to live as long as the process.
py::object make_ufunc(UfuncLoop loop, void *data, int inputs, int outputs, const std::string &name,
                      const std::string &doc);

// The arrays of one call of a loop: the argument of a law, its parameters, and one output or {U, F, k, a}.
struct UfuncArrays {
    char **args;
    const py::ssize_t *steps; // [bytes]
    int argument;             // which input is the law's argument; the others are its parameters
    int inputs;

    double parameter(int which, py::ssize_t i) const
    {
        double value;
        const int input = which < argument ? which : which + 1;
        std::memcpy(&value, args[input] + i * steps[input], sizeof value);
        return value;
    }

    // The end of the run from `first` on in which no parameter changes a bit.
    py::ssize_t run_end(py::ssize_t first, py::ssize_t count) const;
    // Calls over(arrays) for elements first .. end, by copies where those have to be contiguous or cannot be named in
    // doubles; `value` is the output's, 0 .. 3 of {U, F, k, a}, or -1 for all.
    void evaluate(py::ssize_t first, py::ssize_t end, int value, const std::function<void(const nt_strided &)> &over,
                  bool contiguous = false) const;
};

// numpy warns of floating point flags after a loop. The library is built without regard to them (-fno-trapping-math):
// a NaN that it returns is meant, and what a branch not taken would have raised is nothing.
struct QuietFlags {
    ~QuietFlags()
    {
        std::feclearexcept(FE_ALL_EXCEPT);
    }
};

// Sets the Python error of a status, from within a loop, which has no GIL. numpy raises it after the loop.
void set_ufunc_error(nt_status status, const nt_problem &problem, const std::string &what);
