// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "chapters.h"

// A fault from (kind, channel, start, duration, value); a schedule from a list of them.
nt_fault fault_of(const py::handle &entry);
nt_faults faults_of(const py::handle &list);
