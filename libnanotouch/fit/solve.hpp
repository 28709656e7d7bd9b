// SPDX-License-Identifier: BSD-3-Clause
// One fit from a given start; private to fit/.
#pragma once

#include "problem.hpp"

namespace nanotouch
{

struct Found {
    nt_fit_result result;
    double variance, cost; // of a residual, and the sum of all squares, in the residuals' unit
    Points points;         // of the model at the result
};

// Nothing about the fit outlives this object.
class Fit
{
  public:
    Fit(const nt_fit_options &options, const nt_fit_data &data, const Parameters &start);
    nt_status run(Found *found, bool exact); // to the last digits that differences of fits need, or as sigma needs
    // Only the values, for another fit to start from, and the residuals over the noise, RMS.
    nt_status approach(Parameters *value, double *misfit);
    nt_status finish(Found *found);   // the start is known to be the solution
    nt_status begin();                // only what is left at the start
    void weigh();                     // by the noise that the options have now
    std::vector<double> rest() const; // model less data, where it stands [N]

  private:
    void build(ceres::Problem *problem);
    nt_status descend(double tolerance);
    bool descend_freely(double tolerance); // false where a step leads out of the bounds
    bool descend_within_bounds(double tolerance);
    bool is_good() const;
    void fill(Found *found) const;
    void fill_values(nt_fit_result *result) const;

    const nt_fit_options &options_;
    const nt_fit_data &data_;
    const Coordinates coordinates_;
    Residuals residuals_;
    std::unique_ptr<ceres::LossFunction> loss_;
    std::deque<Residual> costs_;
    int iterations_ = 0; // of the last descent
    bool converged_ = true;
};

// NT_OK, or what is wrong with options or data.
nt_status check(const nt_fit_options &options, const nt_fit_data *data, nt_problem *problem);
// Whether fits from several starts have to be compared.
bool has_several_minima(const nt_fit_options &options);
// Whether one start does for all weights of the points.
bool has_one_start(const nt_fit_options &options);
// nt_fit_run, and the model at every point, which it has computed anyway.
nt_status run_with_points(const nt_fit_options &options, const nt_fit_data &data, nt_fit_result *result,
                          std::vector<nt_fit_point> *points, nt_problem *problem);
// Values near the solution, for checked options and data that have one start.
nt_status start_near(const nt_fit_options &options, const nt_fit_data &data, Parameters *value);
// Where a contact of these values lets go; NT_E_UNSUPPORTED where it cannot.
nt_status tear_of(const nt_fit_options &options, const double *value, Tear *tear);
// What a fit found, as it is told.
void write(const nt_fit_options &options, const Found &found, nt_fit_result *result, std::vector<nt_fit_point> *points);

} // namespace nanotouch
