// SPDX-License-Identifier: BSD-3-Clause
// The chapters of _fit besides fit.cpp.
#pragma once
#include "law.h"

py::dict result_dict(const nt_fit_result &result);
void bind_batch(py::module_ &module);
void bind_solving(py::module_ &module);
void bind_path(py::module_ &module);
