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

// Changes of the sum of squares, relative, at which a fit ends: the last step was the root of so many points times
// that, in standard uncertainties, and leaves a tenth of itself or less.
constexpr double exactly = 1e-10; // for differences of fits
constexpr double closely = 1e-8;
constexpr double roughly = 1e-4;
constexpr double near = 0.5; // of the sum of squares that a fit began with, at its end

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

void Fit::build(ceres::Problem *problem)
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
    for (int i = 0; i < coordinates_.size(); i++) {
        const nt_fit_start &bounds = options_.parameter[coordinates_.parameter(i)];
        problem->SetParameterLowerBound(x, i, coordinates_.inverse(i, bounds.minimum));
        problem->SetParameterUpperBound(x, i, coordinates_.inverse(i, bounds.maximum));
    }
}

bool Fit::is_good() const
{
    return residuals_.valid() && !residuals_.met_bound();
}

// By Ceres' small solver, which allocates and copies next to nothing; it knows neither losses nor bounds. What it ends
// at is a change of the sum of squares: a relative one, as long as it begins near enough to the end.
bool Fit::descend_freely(double tolerance)
{
    residuals_.make_bounds_walls(true);
    ceres::TinySolver<Squares> solver;
    solver.options.gradient_tolerance = 1e-14;
    solver.options.parameter_tolerance = 1e-12;
    solver.options.cost_threshold = 0.0;
    Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(residuals_.x(), coordinates_.size());
    iterations_ = 0;
    double before, after = residuals_.sum_of_squares();
    do {
        before = after;
        solver.options.max_num_iterations = options_.max_iterations + 1 - iterations_;
        solver.options.function_tolerance = tolerance * before;
        after = 2.0 * solver.Solve(Squares{residuals_}, &x).final_cost;
        converged_ = solver.summary.status != ceres::TinySolver<Squares>::HIT_MAX_ITERATIONS;
        iterations_ += converged_ ? solver.summary.iterations : options_.max_iterations - iterations_;
    } while (converged_ && after < near * before);
    residuals_.move_to(x.data()); // not the last trial
    return is_good();
}

bool Fit::descend_within_bounds(double tolerance)
{
    const Reserve reserve;
    ceres::Problem::Options ownership;
    ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ownership.evaluation_callback = &residuals_;
    residuals_.make_bounds_walls(false);
    ceres::Problem problem(ownership);
    build(&problem);
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
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);
    if (Reserve::is_used())
        throw std::bad_alloc();
    residuals_.PrepareForEvaluation(true, true); // at the result, not at the last trial
    iterations_ = static_cast<int>(summary.iterations.size()) - 1;
    converged_ = summary.termination_type == ceres::CONVERGENCE;
    return summary.IsSolutionUsable() && is_good();
}

nt_status Fit::descend(double tolerance)
{
    if (begin() != NT_OK)
        return NT_E_NO_CONVERGENCE;
    const std::vector<double> start(residuals_.x(), residuals_.x() + coordinates_.size());
    if (!loss_ && descend_freely(tolerance))
        return NT_OK;
    std::copy(start.begin(), start.end(), residuals_.x());
    return descend_within_bounds(tolerance) ? NT_OK : NT_E_NO_CONVERGENCE;
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
    for (long i = 0; i < residuals_.count(); i++) {
        const double square = residuals_.residual(i) * residuals_.residual(i);
        double rho[3] = {square, 1.0, 0.0};
        if (loss_ && i < data_.count)
            loss_->Evaluate(square, rho);
        found->cost += rho[0];
    }
    fill_values(&found->result);
    fill_uncertainties(options_, residuals_, coordinates_, found->variance, &found->result);
}

nt_status Fit::finish(Found *found)
{
    if (begin() != NT_OK)
        return NT_E_NO_CONVERGENCE;
    fill(found);
    found->result.converged = 1;
    return NT_OK;
}

nt_status Fit::begin()
{
    residuals_.PrepareForEvaluation(true, true);
    return residuals_.valid() ? NT_OK : NT_E_NO_CONVERGENCE;
}

void Fit::weigh()
{
    residuals_.weigh(options_.force_noise);
    loss_ = loss_of(options_, residuals_.unit());
}

std::vector<double> Fit::rest() const
{
    std::vector<double> found(static_cast<std::size_t>(data_.count));
    for (long i = 0; i < data_.count; i++)
        found[static_cast<std::size_t>(i)] = residuals_.unit() * residuals_.residual(i);
    return found;
}

nt_status Fit::approach(Parameters *value, double *misfit)
{
    const nt_status status = descend(roughly);
    if (status != NT_OK)
        return status;
    *value = residuals_.values();
    *misfit = std::sqrt(residuals_.sum_of_squares() / double(data_.count));
    return NT_OK;
}

nt_status Fit::run(Found *found, bool exact)
{
    const nt_status status = descend(exact ? exactly : closely);
    if (status != NT_OK)
        return status;
    fill(found);
    found->result.iterations = iterations_;
    found->result.converged = converged_;
    return NT_OK;
}

} // namespace nanotouch
