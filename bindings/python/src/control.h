// SPDX-License-Identifier: BSD-3-Clause
// The control law of a session: one of the library's by name, or a Python callable.
#pragma once
#include <exception>
#include <set>
#include <utility>

#include "descriptions.h"

// A Python law and the first exception that it has raised, which waits until the touch step is over.
struct OwnLaw {
    py::object call;
    std::exception_ptr error;

    void rethrow()
    {
        if (error)
            std::rethrow_exception(std::exchange(error, nullptr));
    }
};

void set_control(nt_settings &settings, const std::string &name);
// law must outlive whatever is made of the settings.
void set_control(nt_settings &settings, OwnLaw &law);
py::dict motor_bound_as_dict(const nt_motor_bound &bound);
nt_mode mode_of(const std::string &name);
std::string mode_name(nt_mode mode);
