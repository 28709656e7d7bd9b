// SPDX-License-Identifier: BSD-3-Clause
// The chapters of _fit besides fit.cpp.
#pragma once
#include "law.h"

void bind_batch(py::module_ &module);
