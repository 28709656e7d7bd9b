// SPDX-License-Identifier: BSD-3-Clause
// A half of a rig for a session: a shared object, or an object of a Python class.
#pragma once
#include <memory>
#include <vector>

#include "chapters.h"

// Lives at least as long as what was opened with its choice.
struct Half {
    nt_hal_choice choice{};
    std::string option; // for the backend's configure
    Half() = default;
    Half(const Half &) = delete;
    Half &operator=(const Half &) = delete;
    virtual ~Half() = default;
    // Raises what a method of a Python half has raised meanwhile, once; with the GIL.
    virtual void rethrow()
    {
    }
};

// Rows of channels from nanotouch.hal.Channel, with the words that they point to.
struct Rows {
    std::vector<std::string> words;
    std::vector<nt_channel_row> rows;
    void take(const py::list &channels);
};
// The bits of a nanotouch.hal.Capabilities; raises if it is none.
uint32_t can_of(const py::object &capabilities);
// Position, felt, flags and buttons of a nanotouch.hal.Reading, and what of them is valid; raises if they are not that.
void take_measured(const py::object &given, nt_reading &reading);
int64_t time_of(const py::object &given); // [ns]

// What a backend says; bytes that are no UTF-8 are shown as such.
py::str text_of(const char *text);

// given: None (a null pointer: simulated), nanotouch.hal.SharedObject, or an object of a class derived from
// nanotouch.hal.Master or Slave; raises if it is none of them, is the other half, or cannot be loaded.
std::shared_ptr<Half> half_of(const py::object &given, nt_half half);

// A nanotouch.rig_file.Converters; opens its buses and lines.
std::shared_ptr<Half> converter_half_of(const py::object &given, nt_half half);
void bind_converters(py::module_ &module);
void bind_drive(py::module_ &module); // of the submodule that it makes
void bind_timing(py::module_ &rigs);

// A nanotouch.hal.Replay.
std::shared_ptr<Half> replay_half_of(const py::object &given, nt_half half);

// A nanotouch.hal.Mailbox.
std::shared_ptr<Half> mailbox_half_of(const py::object &given, nt_half half);
void bind_mailbox(py::module_ &module);
