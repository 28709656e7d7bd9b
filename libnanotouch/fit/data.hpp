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

// Means of so many neighbours each, or one more.
class Means
{
  public:
    Means(const nt_fit_data &data, long size);
    nt_fit_data data() const
    {
        return {position_.data(), force_.data(), static_cast<long>(position_.size()), 1, 1};
    }

  private:
    std::vector<double> position_, force_;
};

} // namespace nanotouch
