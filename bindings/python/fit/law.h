// SPDX-License-Identifier: BSD-3-Clause
// A law given as a Python function, seen by the C library as nt_fit_law.
#pragma once

#include <deque>
#include <exception>
#include <memory>
#include <string>

#include "../src/chapters.h"
#include "nanotouch/fit.h"

class PythonLaw
{
  public:
    // parameters: (name, unit, initial, minimum, maximum); force(indentation, radius, values) -> forces, arrays.
    PythonLaw(const std::string &name, const py::list &parameters, const py::function &force);
    PythonLaw(const PythonLaw &) = delete;
    PythonLaw &operator=(const PythonLaw &) = delete;

    // The exception that the function raised last, if it did.
    void rethrow();

    nt_fit_law law{};

  private:
    static nt_status call(const nt_fit_options *options, const double *value, long count, const double *indentation,
                          double *force);

    std::deque<std::string> texts_;
    py::function force_;
    std::exception_ptr raised_;
};

// Options together with the law of the user's own that they may point to.
struct Options : nt_fit_options {
    std::shared_ptr<PythonLaw> own;
};
