// SPDX-License-Identifier: BSD-3-Clause
// A law of the user's own, given as a function that fills an array of forces; private to fit/.
#pragma once

#include "model.hpp"

namespace nanotouch
{

class CustomModel : public Model
{
  public:
    explicit CustomModel(const nt_fit_options &options) : options_(options)
    {
    }
    nt_status prepare(const Parameters &value) override;
    nt_status points_at(const nt_fit_data &data, Points *points) const override;
    nt_status tear(Tear *tear) const override;
    nt_status travel(double force, double *travel) const override;
    void describe(double deepest, nt_fit_result *result) const override;

  private:
    using Array = std::vector<double>;
    nt_status force_at(const Parameters &value, const Array &indentation, Array *force) const;
    nt_status slope_at(const Array &indentation, double step, Array *stiffness) const;
    nt_status solve(const Array &base, double step, Array *indentation, Array *force) const;
    nt_status differentiate(int parameter, const Array &indentation, Array *slope) const;

    const nt_fit_options &options_;
    Parameters value_{};
    double compliance_ = 0.0; // 1/k_c [m/N]
};

} // namespace nanotouch
