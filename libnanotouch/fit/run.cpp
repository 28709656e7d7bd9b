// SPDX-License-Identifier: BSD-3-Clause
// Runs a fit: checks, start, Ceres, uncertainties. See fit.h for the model, model.cpp for its derivatives.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <new>

#include "data.hpp"
#include "guess.hpp"
#include "problem.hpp"

namespace nanotouch
{

namespace
{

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

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

struct Found {
    nt_fit_result result;
    double variance, cost; // of a residual, and the sum of all squares, in the residuals' unit
};

// Nothing about the fit outlives this object.
class Fit
{
  public:
    Fit(const nt_fit_options &options, const nt_fit_data &data, const Parameters &start)
        : options_(options), data_(data), coordinates_(options, data, start), residuals_(options, data, coordinates_),
          loss_(loss_of(options, residuals_.unit()))
    {
    }
    nt_status run(Found *found);

  private:
    void build(ceres::Problem *problem);
    bool solve(ceres::Problem *problem, ceres::Solver::Summary *summary);
    double noise_variance() const;
    bool covariance(ceres::Problem *problem, std::vector<double> *covariance);
    double resolution(const std::vector<double> &covariance, int i) const;
    void fill_values(const ceres::Solver::Summary &summary, nt_fit_result *result) const;
    void fill_uncertainties(const std::vector<double> &covariance, double variance, nt_fit_result *result) const;
    bool at_bound(int i) const;

    const nt_fit_options &options_;
    const nt_fit_data &data_;
    const Coordinates coordinates_;
    Residuals residuals_;
    std::unique_ptr<ceres::LossFunction> loss_;
    std::deque<Residual> costs_;
};

void Fit::build(ceres::Problem *problem)
{
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

bool Fit::solve(ceres::Problem *problem, ceres::Solver::Summary *summary)
{
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_QR;
    solver.logging_type = ceres::SILENT;
    solver.num_threads = 1; // deterministic; the caller may run fits in parallel
    solver.max_num_iterations = options_.max_iterations;
    solver.function_tolerance = 1e-12;
    solver.gradient_tolerance = 1e-14;
    solver.parameter_tolerance = 1e-12;
    ceres::Solve(solver, problem, summary);
    residuals_.PrepareForEvaluation(true, true); // at the result, not at the last trial
    return summary->IsSolutionUsable() && residuals_.valid();
}

// Variance of one residual in its unit; with a robust loss that of Huber's M-estimate, psi(u) = rho'(u^2) u.
double Fit::noise_variance() const
{
    double squares = 0.0, slopes = 0.0;
    for (long i = 0; i < data_.count; i++) {
        const double u = residuals_.residual(i), s = u * u;
        double rho[3] = {s, 1.0, 0.0};
        if (loss_)
            loss_->Evaluate(s, rho);
        squares += rho[1] * u * rho[1] * u;
        slopes += rho[1] + 2.0 * s * rho[2];
    }
    const double mean_slope = slopes / double(data_.count);
    return squares / double(data_.count - coordinates_.size()) / (mean_slope * mean_slope);
}

// (J^T J)^-1, its null space left out.
bool Fit::covariance(ceres::Problem *problem, std::vector<double> *covariance)
{
    ceres::Covariance::Options how;
    how.algorithm_type = ceres::DENSE_SVD;
    how.null_space_rank = -1;
    how.apply_loss_function = false;
    how.num_threads = 1;
    ceres::Covariance estimate(how);
    const double *x = residuals_.x();
    if (!estimate.Compute(std::vector<std::pair<const double *, const double *>>{{x, x}}, problem))
        return false;
    covariance->resize(static_cast<std::size_t>(coordinates_.size() * coordinates_.size()));
    return estimate.GetCovarianceBlock(x, x, covariance->data());
}

// Diagonal of C J^T J: 1 for a parameter that is determined, less if it takes part in the null space.
double Fit::resolution(const std::vector<double> &covariance, int i) const
{
    double found = 0.0;
    for (long row = 0; row < residuals_.count(); row++) {
        const double *gradient = residuals_.gradient(row);
        double product = 0.0;
        for (int j = 0; j < coordinates_.size(); j++)
            product += covariance[static_cast<std::size_t>(i * coordinates_.size() + j)] * gradient[j];
        found += product * gradient[i];
    }
    return found;
}

void Fit::fill_values(const ceres::Solver::Summary &summary, nt_fit_result *result) const
{
    const Parameters value = residuals_.values();
    const Model &model = residuals_.model();
    double squares = 0.0, deepest = data_.position[0];
    for (long i = 0; i < data_.count; i++) {
        squares += residuals_.residual(i) * residuals_.residual(i);
        deepest = std::max(deepest, data_.position[i * data_.position_stride]);
    }
    for (int i = 0; i < NT_FIT_PARAMETERS; i++)
        result->value[i] = nt_fit_model_has(options_.model, static_cast<nt_fit_parameter>(i))
                               ? value[static_cast<std::size_t>(i)]
                               : not_a_number;
    result->residual_rms = residuals_.unit() * std::sqrt(squares / double(data_.count));
    result->transition_parameter = options_.model == NT_MAUGIS ? model.law().maugis.lambda : not_a_number;
    result->pull_off_force = nt_contact_law_pull_off_force(&model.law());
    Point point;
    Track track;
    nt_law_value there{};
    if (model.at(deepest, &track, &point) == NT_OK)
        (void)model.law_value(point.indentation, &there);
    result->contact_radius = there.a;
    result->contact_stiffness = there.k;
    result->iterations = static_cast<int>(summary.iterations.size()) - 1;
    result->converged = summary.termination_type == ceres::CONVERGENCE;
}

bool Fit::at_bound(int i) const
{
    const nt_fit_start &bounds = options_.parameter[coordinates_.parameter(i)];
    const double value = residuals_.values()[static_cast<std::size_t>(coordinates_.parameter(i))];
    const double x = coordinates_.inverse(i, value);
    return std::min(x - coordinates_.inverse(i, bounds.minimum), coordinates_.inverse(i, bounds.maximum) - x) < 1e-6;
}

void Fit::fill_uncertainties(const std::vector<double> &covariance, double variance, nt_fit_result *result) const
{
    const bool noise_known = options_.force_noise > 0.0;
    const double scale = noise_known ? std::max(1.0, variance) : variance;
    result->misfit = noise_known ? variance : not_a_number;
    const Parameters value = residuals_.values();
    const int size = coordinates_.size();
    std::vector<bool> resolved;
    for (int i = 0; i < size; i++)
        resolved.push_back(std::fabs(resolution(covariance, i) - 1.0) < 1e-3);
    for (int i = 0; i < size; i++) {
        const int p = coordinates_.parameter(i);
        for (int j = 0; j < size; j++) {
            const bool known = resolved[static_cast<std::size_t>(i)] && resolved[static_cast<std::size_t>(j)];
            result->covariance[p][coordinates_.parameter(j)] =
                known    ? scale * covariance[static_cast<std::size_t>(i * size + j)] * coordinates_.slope(i, value) *
                               coordinates_.slope(j, value)
                : i == j ? infinity
                         : not_a_number;
        }
        result->sigma[p] = std::sqrt(result->covariance[p][p]);
        result->identifiable[p] = result->sigma[p] < NT_FIT_IDENTIFIABLE * coordinates_.slope(i, value) && !at_bound(i);
    }
}

nt_status Fit::run(Found *found)
{
    residuals_.PrepareForEvaluation(true, true);
    if (!residuals_.valid())
        return NT_E_NO_CONVERGENCE;
    ceres::Problem::Options ownership;
    ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ownership.evaluation_callback = &residuals_;
    ceres::Problem problem(ownership);
    build(&problem);
    ceres::Solver::Summary summary;
    std::vector<double> inverse;
    if (!solve(&problem, &summary) || !covariance(&problem, &inverse))
        return NT_E_NO_CONVERGENCE;
    *found = {{}, noise_variance(), 2.0 * summary.final_cost};
    fill_values(summary, &found->result);
    fill_uncertainties(inverse, found->variance, &found->result);
    return NT_OK;
}

void write_message(const nt_fit_options &options, nt_fit_result *result)
{
    char *text = result->message;
    int used = std::snprintf(text, NT_FIT_MESSAGE,
                             result->converged ? "converged after %d iterations"
                                               : "stopped after %d iterations without convergence",
                             result->iterations);
    const char *separator = "; not determined by these data: ";
    for (int p = 0; p < NT_FIT_PARAMETERS && used < NT_FIT_MESSAGE; p++) {
        const auto parameter = static_cast<nt_fit_parameter>(p);
        if (options.parameter[p].fixed || !nt_fit_model_has(options.model, parameter) || result->identifiable[p])
            continue;
        used += std::snprintf(text + used, static_cast<std::size_t>(NT_FIT_MESSAGE - used), "%s%s", separator,
                              nt_fit_parameter_name(parameter));
        separator = ", ";
    }
}

// Where the range h0 is to be found too, there can be several minima about as good: all are looked at, the best is
// returned, and a parameter in which another good one differs is not determined.
constexpr double transition_parameters[] = {0.05, 0.2, 0.6, 1.5, 4.0}; // Maugis' lambda to start from
constexpr double as_good = 4.0;                                        // difference in chi^2, two standard deviations

nt_status run_from(const nt_fit_options &options, const nt_fit_data &data, double lambda, Found *found)
{
    Parameters start;
    const nt_status status = guess(options, data, lambda, &start);
    if (status != NT_OK)
        return status;
    Fit fit(options, data, start);
    return fit.run(found);
}

nt_status run_from_all(const nt_fit_options &options, const nt_fit_data &data, nt_fit_result *result)
{
    std::vector<Found> all;
    for (const double lambda : transition_parameters) {
        Found found;
        const nt_status status = run_from(options, data, lambda, &found);
        if (status == NT_OK)
            all.push_back(found);
        else if (status != NT_E_NO_CONVERGENCE)
            return status;
    }
    if (all.empty())
        return NT_E_NO_CONVERGENCE;
    Found best =
        *std::min_element(all.begin(), all.end(), [](const Found &a, const Found &b) { return a.cost < b.cost; });
    for (const Found &other : all) {
        if (other.cost - best.cost > as_good * best.variance)
            continue;
        for (int p = 0; p < NT_FIT_PARAMETERS; p++)
            if (is_logarithmic(p) &&
                std::fabs(std::log(other.result.value[p] / best.result.value[p])) > NT_FIT_IDENTIFIABLE)
                best.result.identifiable[p] = 0;
    }
    *result = best.result;
    return NT_OK;
}

nt_status run(const nt_fit_options &options, const nt_fit_data &data, nt_fit_result *result)
{
    const nt_fit_start &range = options.parameter[NT_FIT_COHESIVE_RANGE];
    nt_fit_result made;
    nt_status status;
    if (options.model == NT_MAUGIS && std::isnan(range.initial)) {
        status = run_from_all(options, data, &made);
    } else {
        Found found;
        status = run_from(options, data, not_a_number, &found);
        made = found.result;
    }
    if (status == NT_OK) {
        write_message(options, &made);
        *result = made;
    }
    return status;
}

} // namespace

} // namespace nanotouch

using nanotouch::Model;
using nanotouch::Parameters;
using nanotouch::Point;
using nanotouch::Track;

nt_status nt_fit_run(const nt_fit_options *options, const nt_fit_data *data, nt_fit_result *result, nt_problem *problem)
{
    nt_status status = nt_fit_check(options, problem);
    if (status == NT_OK)
        status = result ? nanotouch::check_data(*options, data, problem) : NT_E_ARGUMENT;
    if (status != NT_OK)
        return status;
    try {
        return nanotouch::run(*options, *data, result);
    } catch (const std::bad_alloc &) {
        return NT_E_NO_MEMORY;
    } catch (...) {
        return NT_E_NO_CONVERGENCE;
    }
}

nt_status nt_fit_model_at(const nt_fit_options *options, const double value[NT_FIT_PARAMETERS], double position,
                          nt_fit_point *point)
{
    if (!options || !value || !point)
        return NT_E_ARGUMENT;
    Parameters values;
    std::copy_n(value, NT_FIT_PARAMETERS, values.begin());
    Model model;
    Track track;
    Point found;
    nt_status status = nt_fit_check(options, nullptr);
    if (status == NT_OK)
        status = model.prepare(*options, values);
    if (status == NT_OK)
        status = model.at(position, &track, &found);
    if (status != NT_OK)
        return status;
    point->force = found.force;
    point->indentation = found.indentation;
    for (int i = 0; i < NT_FIT_PARAMETERS; i++) {
        const auto p = static_cast<std::size_t>(i);
        point->gradient[i] = !nt_fit_model_has(options->model, static_cast<nt_fit_parameter>(i)) ? 0.0
                             : nanotouch::is_logarithmic(i) ? found.gradient[p] / values[p]
                                                            : found.gradient[p];
    }
    return NT_OK;
}

nt_status nt_fit_model_n(const nt_fit_options *options, const double value[NT_FIT_PARAMETERS], const nt_fit_data *data,
                         double *force)
{
    if (!options || !value || !data || !data->position || !force)
        return NT_E_ARGUMENT;
    Parameters values;
    std::copy_n(value, NT_FIT_PARAMETERS, values.begin());
    Model model;
    nt_status status = nt_fit_check(options, nullptr);
    if (status == NT_OK)
        status = model.prepare(*options, values);
    Track track;
    for (long i = 0; i < data->count && status == NT_OK; i++) {
        Point point;
        status = model.at(data->position[i * data->position_stride], &track, &point);
        if (status == NT_OK)
            force[i] = point.force;
    }
    return status;
}
