// SPDX-License-Identifier: BSD-3-Clause
// A fit with what is known of its points beforehand, and what it is worth; private to fit/.
#pragma once

#include <vector>

#include "internal/fit.h"
#include "model.hpp"
#include "nanotouch/fit.h"

namespace nanotouch
{

class Solving
{
  public:
    Solving(const nt_fit_options &options, const nt_fit_known &known, const nt_fit_data &data, nt_problem *problem);
    // Everything of the solution. May throw std::bad_alloc.
    nt_status run();
    const nt_fit_solution &solution() const
    {
        return solution_;
    }

  private:
    void let_vary();
    void know(nt_fit_parameter parameter, double value, double sigma);
    nt_status fit();
    nt_status fit_with_scatter();
    nt_status fit_by_scatter(double *used);
    void look();
    void look_at(const std::vector<double> &rest);
    nt_status fit_without_false_tear();
    nt_status contradicts_tear(bool *contradicts);
    nt_status leave_steep_part();
    nt_status doubt_calibration();
    nt_status fit_any_sensitivity(bool *doubtful);
    bool is_exact() const;
    bool is_as_known() const;
    double wanted_noise() const;
    double correlated_noise() const;
    double noise() const; // of the free cantilever, as far as the points are worth independent ones [N]
    double rating() const;
    void judge();
    void doubt_modulus();
    // w that no tear tells is not known where a tenth of it describes the points nearly as well: near w = 0 the force
    // goes as its root, and the standard uncertainty is too small (profile.cpp).
    void doubt_adhesion();
    double noise_of_modulus() const;
    bool is_bent() const;

    const nt_fit_options &given_;
    const nt_fit_known &known_;
    nt_fit_data data_;
    nt_problem *const problem_;
    double largest_ = 0.0, scatter_ = 0.0; // [N]
    Tear tear_{};                          // of the fit, where it is a datum
    std::vector<nt_fit_point> points_;
    nt_fit_solution solution_{};
};

// Whether a law asks for a quantity of this name at this place.
bool asks(const nt_fit_options &options, nt_fit_parameter place, const char *name);

} // namespace nanotouch
