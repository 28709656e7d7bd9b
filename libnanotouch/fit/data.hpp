// SPDX-License-Identifier: BSD-3-Clause
// The points of a curve; private to fit/.
#pragma once

#include "model.hpp"

namespace nanotouch
{

// NT_OK, or what is wrong with the data for these options.
nt_status check_data(const nt_fit_options &options, const nt_fit_data *data, nt_problem *problem);

struct Span {
    double lowest, highest;
    double width() const
    {
        return highest - lowest;
    }
    double largest() const
    {
        return highest > -lowest ? highest : -lowest;
    }
};
Span position_span(const nt_fit_data &data);
Span force_span(const nt_fit_data &data);

} // namespace nanotouch
