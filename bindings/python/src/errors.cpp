// SPDX-License-Identifier: BSD-3-Clause
#include "chapters.h"

static const char *exception_name(nt_status status)
{
    switch (status) {
    case NT_E_NO_SOLUTION:
    case NT_E_NO_CONVERGENCE:
        return "SolverError";
    case NT_E_DEVICE:
    case NT_E_UNSUPPORTED:
        return "DeviceError";
    case NT_E_STATE:
    case NT_E_CAPACITY:
    case NT_E_NO_MEMORY:
        return "Error";
    default:
        return "InvalidValue";
    }
}

void raise(nt_status status, const std::string &message)
{
    py::object type = py::module_::import("nanotouch.errors").attr(exception_name(status));
    PyErr_SetString(type.ptr(), message.c_str());
    throw py::error_already_set();
}

void raise_on(nt_status status, const std::string &what)
{
    if (status != NT_OK)
        raise(status, what + ": " + nt_status_message(status));
}

void raise_on(nt_status status, const nt_problem &problem, const std::string &what)
{
    if (status == NT_OK)
        return;
    if (!problem.field && problem.code == NT_PROBLEM_RANGE)
        raise_on(status, what);
    char text[NT_PROBLEM_TEXT];
    raise(status, what + ": " + nt_problem_print(&problem, text, sizeof text));
}
