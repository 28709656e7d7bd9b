// SPDX-License-Identifier: BSD-3-Clause
// One fit from a given start: Ceres, then the values it found. uncertainty.cpp says what they are worth.
#include "solve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "judgement.hpp"
#include "reserve.hpp"
#include "uncertainty.hpp"

namespace nanotouch
{

namespace
{

// Changes of the sum of squares, relative, at which a fit ends.
constexpr double exactly = 1e-10; // a thousandth of a standard uncertainty
constexpr double roughly = 1e-4;

std::unique_ptr<ceres::LossFunction> loss_of(const nt_fit_options &options, double unit)
{
    const double scale = options.loss_scale / unit;
    switch (options.loss) {
    case NT_LOSS_HUBER:
        return std::make_unique<ceres::HuberLoss>(scale);
    case NT_LOSS_SOFT_L1:
        return std::make_unique<ceres::SoftLOneLoss>(scale);
    case NT_LOSS_CAUCHY:
        return std::make_unique<ceres::CauchyLoss>(scale);
    default:
        return nullptr;
    }
}

} // namespace

Fit::Fit(const nt_fit_options &options, const nt_fit_data &data, const Parameters &start)
    : options_(options), data_(data), coordinates_(options, data, start), residuals_(options, data, coordinates_),
      loss_(loss_of(options, residuals_.unit()))
{
}

void Fit::build(ceres::Problem *problem, bool bounded)
{
    costs_.clear();
    double *x = residuals_.x();
    problem->AddParameterBlock(x, coordinates_.size());
    const long single = loss_ ? data_.count : 0;
    for (long i = 0; i < single; i++) {
        costs_.emplace_back(residuals_, i, 1, coordinates_.size());
        problem->AddResidualBlock(&costs_.back(), loss_.get(), x);
    }
    if (single < residuals_.count()) {
        costs_.emplace_back(residuals_, single, residuals_.count() - single, coordinates_.size());
        problem->AddResidualBlock(&costs_.back(), nullptr, x);
    }
    for (int i = 0; i < coordinates_.size() && bounded; i++) {
        const nt_fit_start &bounds = options_.parameter[coordinates_.parameter(i)];
        problem->SetParameterLowerBound(x, i, coordinates_.inverse(i, bounds.minimum));
        problem->SetParameterUpperBound(x, i, coordinates_.inverse(i, bounds.maximum));
    }
}

bool Fit::solve(bool bounded, double tolerance, ceres::Solver::Summary *summary)
{
    ceres::Problem::Options ownership;
    ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ownership.evaluation_callback = &residuals_;
    ceres::Problem problem(ownership);
    build(&problem, bounded);
    if (Reserve::is_used())
        throw std::bad_alloc();
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    solver.logging_type = ceres::SILENT;
    solver.num_threads = 1; // deterministic; the caller may run fits in parallel
    solver.max_num_iterations = options_.max_iterations;
    solver.function_tolerance = tolerance;
    solver.gradient_tolerance = 1e-14;
    solver.parameter_tolerance = 1e-12;
    residuals_.make_bounds_walls(!bounded);
    ceres::Solve(solver, &problem, summary);
    if (Reserve::is_used())
        throw std::bad_alloc();
    residuals_.PrepareForEvaluation(true, true); // at the result, not at the last trial
    return summary->IsSolutionUsable() && residuals_.valid() && !residuals_.met_bound();
}

// Within bounds Ceres searches each step for a shorter one, at the cost of half of all evaluations: only where a step
// without them leads out.
nt_status Fit::descend(double tolerance, ceres::Solver::Summary *summary)
{
    residuals_.PrepareForEvaluation(true, true);
    if (!residuals_.valid())
        return NT_E_NO_CONVERGENCE;
    const Reserve reserve;
    return solve(false, tolerance, summary) || solve(true, tolerance, summary) ? NT_OK : NT_E_NO_CONVERGENCE;
}

void Fit::fill_values(nt_fit_result *result) const
{
    const Parameters value = residuals_.values();
    double squares = 0.0, deepest = data_.position[0];
    for (long i = 0; i < data_.count; i++) {
        squares += residuals_.residual(i) * residuals_.residual(i);
        deepest = std::max(deepest, data_.position[i * data_.position_stride]);
    }
    for (int i = 0; i < NT_FIT_PARAMETERS; i++)
        result->value[i] = nt_fit_quantity_of(&options_, static_cast<nt_fit_parameter>(i)).name
                               ? value[static_cast<std::size_t>(i)]
                               : std::numeric_limits<double>::quiet_NaN();
    result->residual_rms = residuals_.unit() * std::sqrt(squares / double(data_.count));
    judge_residuals(options_, data_, residuals_, result);
    residuals_.model().describe(deepest, result);
}

void Fit::fill(Found *found) const
{
    *found = {{}, noise_variance(residuals_, coordinates_, loss_.get()), 0.0, residuals_.points()};
    for (long i = 0; i < residuals_.count(); i++)
        found->cost += residuals_.residual(i) * residuals_.residual(i);
    fill_values(&found->result);
    fill_uncertainties(options_, residuals_, coordinates_, found->variance, &found->result);
}

nt_status Fit::finish(Found *found)
{
    residuals_.PrepareForEvaluation(true, true);
    if (!residuals_.valid())
        return NT_E_NO_CONVERGENCE;
    fill(found);
    found->result.converged = 1;
    return NT_OK;
}

nt_status Fit::approach(Parameters *value)
{
    ceres::Solver::Summary summary;
    const nt_status status = descend(roughly, &summary);
    if (status == NT_OK)
        *value = residuals_.values();
    return status;
}

nt_status Fit::run(Found *found)
{
    ceres::Solver::Summary summary;
    const nt_status status = descend(exactly, &summary);
    if (status != NT_OK)
        return status;
    fill(found);
    found->cost = 2.0 * summary.final_cost;
    found->result.iterations = static_cast<int>(summary.iterations.size()) - 1;
    found->result.converged = summary.termination_type == ceres::CONVERGENCE;
    return NT_OK;
}

} // namespace nanotouch
