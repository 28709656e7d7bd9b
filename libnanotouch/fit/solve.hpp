// SPDX-License-Identifier: BSD-3-Clause
// One fit from a given start; private to fit/.
#pragma once

#include "problem.hpp"

namespace nanotouch
{

struct Found {
    nt_fit_result result;
    double variance, cost;     // of a residual, and the sum of all squares, in the residuals' unit
    std::vector<Point> points; // of the model at the result
};

// Nothing about the fit outlives this object.
class Fit
{
  public:
    Fit(const nt_fit_options &options, const nt_fit_data &data, const Parameters &start);
    nt_status run(Found *found);
    nt_status approach(Parameters *value); // only the values, for another fit to start from
    nt_status finish(Found *found);        // the start is known to be the solution

  private:
    void build(ceres::Problem *problem, bool bounded);
    nt_status descend(double tolerance, ceres::Solver::Summary *summary);
    bool solve(bool bounded, double tolerance, ceres::Solver::Summary *summary);
    void fill(Found *found) const;
    void fill_values(nt_fit_result *result) const;

    const nt_fit_options &options_;
    const nt_fit_data &data_;
    const Coordinates coordinates_;
    Residuals residuals_;
    std::unique_ptr<ceres::LossFunction> loss_;
    std::deque<Residual> costs_;
};

// Whether fits from several starts have to be compared.
bool has_several_minima(const nt_fit_options &options);
// nt_fit_run, and the model at every point, which it has computed anyway.
nt_status run_with_points(const nt_fit_options &options, const nt_fit_data &data, nt_fit_result *result,
                          std::vector<nt_fit_point> *points, nt_problem *problem);
// A fit like the one whose result is there, with other weights, from its values on.
nt_status run_near(const nt_fit_options &options, const nt_fit_data &data, nt_fit_result *result,
                   std::vector<nt_fit_point> *points);

} // namespace nanotouch
