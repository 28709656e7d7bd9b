// SPDX-License-Identifier: BSD-3-Clause
// Levenberg and Marquardt's steps on the binned curve. An exponent at 0 that would fall further is held there; what the
// step would have been is reported.
#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "core/problem.h"
#include "internal/curves.h"
#include "nanotouch/curves.h"
#include "path_fit.hpp"

namespace nanotouch
{

namespace
{

constexpr double greatest_exponent = 0.85, widest_step = 2.0; // of a logarithm
constexpr double converged = 1e-4;                            // standard deviations that a step would still move
constexpr double no_better = 1e-4; // of chi^2, over its mean, that an almost undamped step would still gain
constexpr double undamped = 1e-3;
constexpr double opposite = 1e-3;    // speed back over that forth, from where drag shows
constexpr double lost = 1e12;        // damping that no step survives
constexpr double good_enough = 2.0;  // reduced chi^2: no other start is tried
constexpr double null_space = 1e-13; // of the scaled normal equations
constexpr double lowest_modulus = 1e-3, highest_modulus = 1e13, shortest_time = 1e-7, longest_time = 1e7;

} // namespace

nt_status PathFit::look(const PathValues &value, bool with_slopes, double *cost)
{
    nt_viscoelastic_result result{};
    const nt_status status = law_.evaluate(value, with_slopes ? &free_ : nullptr, &result);
    if (status != NT_OK)
        return status;
    seen_ = result;
    double sum = 0.0;
    for (std::size_t i = 0; i < bins_.size(); i++)
        sum += bins_.count[i] * std::pow(bins_.force[i] - law_.force[i], 2);
    *cost = sum / (options_.noise * options_.noise);
    return std::isfinite(*cost) ? NT_OK : NT_E_NO_CONVERGENCE;
}

void PathFit::make_equations()
{
    const Eigen::Index nodes = law_.jacobian.rows(), columns = law_.jacobian.cols();
    Eigen::VectorXd residual(nodes), root(nodes);
    for (Eigen::Index i = 0; i < nodes; i++) {
        const auto node = std::size_t(i);
        root[i] = std::sqrt(bins_.count[node]) / options_.noise;
        residual[i] = root[i] * (bins_.force[node] - law_.force[node]);
    }
    Eigen::MatrixXd weighed = root.asDiagonal() * law_.jacobian;
    for (Eigen::Index c = 0; c < columns; c++)
        weighed.col(c) *= scale(free_[std::size_t(c)]);
    square_ = weighed.transpose() * weighed;
    product_ = weighed.transpose() * residual;
}

// Of the varied numbers; of an exponent at its floor 0 where it is held there.
Eigen::VectorXd PathFit::step(double damping, bool hold_floor) const
{
    const Eigen::Index count = square_.rows();
    Eigen::VectorXd norm(count);
    for (Eigen::Index i = 0; i < count; i++)
        norm[i] = square_(i, i) > 0.0 ? 1.0 / std::sqrt(square_(i, i)) : 0.0;
    Eigen::MatrixXd scaled = norm.asDiagonal() * square_ * norm.asDiagonal();
    Eigen::VectorXd right = norm.cwiseProduct(product_);
    for (Eigen::Index i = 0; i < count; i++) {
        scaled(i, i) += damping + null_space;
        if ((hold_floor && at_floor(free_[std::size_t(i)])) || norm[i] == 0.0) {
            scaled.row(i).setZero();
            scaled.col(i).setZero();
            scaled(i, i) = 1.0;
            right[i] = 0.0;
        }
    }
    return norm.cwiseProduct(scaled.ldlt().solve(right));
}

PathValues PathFit::moved(const Eigen::VectorXd &step) const
{
    PathValues value = value_;
    for (std::size_t c = 0; c < free_.size(); c++) {
        const int p = free_[c];
        double &v = value[std::size_t(p)];
        const double by = step[Eigen::Index(c)];
        const bool time = p > 0 && p % 2 == 0;
        if (law_.is_logarithmic(p))
            v = std::clamp(v * std::exp(std::clamp(by, -widest_step, widest_step)),
                           time ? shortest_time : lowest_modulus, time ? longest_time : highest_modulus);
        else if (law_.is_exponent(p))
            v = std::clamp(v + by, 0.0, greatest_exponent);
        else
            v += by;
    }
    double &touch = value[NT_FIT_PATH_CONTACT];
    touch = std::max(touch, bins_.position[0]);
    return value;
}

nt_status PathFit::run(const PathValues &start)
{
    value_ = start;
    nt_status status = look(value_, true, &cost_);
    double damping = 1e-3;
    for (; status == NT_OK && iterations_ < options_.max_iterations && !converged_; iterations_++) {
        make_equations();
        bool taken = false;
        while (!taken && damping < lost) {
            const Eigen::VectorXd full = step(damping, false);
            bool falls = false; // an exponent below its floor
            for (std::size_t c = 0; c < free_.size(); c++)
                falls = falls || (at_floor(free_[c]) && full[Eigen::Index(c)] < 0.0);
            const Eigen::VectorXd by = falls ? step(damping, true) : full;
            const PathValues next = moved(by);
            double cost;
            const bool valid = look(next, true, &cost) == NT_OK;
            taken = valid && cost <= cost_;
            const double unit = std::max(1.0, cost_ / double(weighed()));
            converged_ = taken && (by.dot(square_ * by) < converged * converged * unit ||
                                   (damping <= undamped && cost_ - cost < no_better * unit));
            if (taken) {
                value_ = next;
                cost_ = cost;
            }
            damping = taken ? std::max(0.1 * damping, 1e-12) : std::max(10.0 * damping, 1e-6);
        }
        if (!taken) { // no step is better, to rounding
            converged_ = true;
            status = look(value_, true, &cost_);
        }
    }
    if (status == NT_OK)
        make_equations();
    return status;
}

long PathFit::weighed() const
{
    return std::max<long>(1, std::count_if(bins_.count.begin(), bins_.count.end(), [](double n) { return n > 0.0; }));
}

// Standard uncertainties from the inverse of the normal equations, times factor.
void PathFit::write_sigmas(double factor, nt_fit_path_result *result) const
{
    const Eigen::Index count = square_.rows();
    Eigen::VectorXd norm(count);
    for (Eigen::Index i = 0; i < count; i++)
        norm[i] = square_(i, i) > 0.0 ? 1.0 / std::sqrt(square_(i, i)) : 0.0;
    const auto inverse = [&](bool hold_floor) {
        Eigen::MatrixXd scaled = norm.asDiagonal() * square_ * norm.asDiagonal();
        for (Eigen::Index i = 0; i < count; i++)
            if ((hold_floor && at_floor(free_[std::size_t(i)])) || norm[i] == 0.0) {
                scaled.row(i).setZero();
                scaled.col(i).setZero();
                scaled(i, i) = 1.0;
            }
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(scaled);
        const Eigen::VectorXd size =
            modes.eigenvalues().unaryExpr([](double x) { return x > null_space ? 1.0 / x : 1.0 / null_space; });
        return Eigen::MatrixXd(modes.eigenvectors() * size.asDiagonal() * modes.eigenvectors().transpose());
    };
    const Eigen::MatrixXd held = inverse(true), all = inverse(false);
    for (Eigen::Index i = 0; i < count; i++)
        for (Eigen::Index j = 0; j < count; j++) {
            const int p = free_[std::size_t(i)], q = free_[std::size_t(j)];
            const bool floor = at_floor(p) || at_floor(q);
            const double here = floor ? (p == q ? all(i, j) : 0.0) : held(i, j);
            const double variance = factor * here * norm[i] * norm[j] * scale(p) * scale(q);
            result->covariance[p][q] = variance;
            if (p == q)
                result->sigma[p] = norm[i] > 0.0 ? std::sqrt(variance) : infinity;
        }
}

void PathFit::write_shape(nt_fit_path_result *result) const
{
    const auto top = std::max_element(law_.contact_force.begin(), law_.contact_force.end());
    std::size_t touch = 0;
    while (touch + 1 < bins_.size() && bins_.position[touch] < value_[NT_FIT_PATH_CONTACT])
        touch++;
    result->peak = *top;
    result->indentation = *std::max_element(law_.indentation.begin(), law_.indentation.end());
    result->contact_time = bins_.time[std::size_t(top - law_.contact_force.begin())] - bins_.time[touch];
    result->kernel_error = seen_.kernel_error;
    result->by_springs = seen_.by_springs;
}

void PathFit::write(nt_fit_path_result *result)
{
    *result = nt_fit_path_result{};
    std::vector<double> rest;
    for (std::size_t i = 0; i < bins_.size(); i++)
        if (bins_.count[i] > 0.0)
            rest.push_back((bins_.force[i] - law_.force[i]) * std::sqrt(bins_.count[i]));
    result->chi_square = cost_;
    result->bins = long(rest.size());
    result->correlation = nt_curve_residual_correlation(rest.data(), result->bins);
    const double freedom = std::max(double(result->bins) - double(free_.size()), 1.0);
    write_sigmas(std::max(1.0, cost_ / freedom) * result->correlation, result);
    for (int p = 0; p < NT_FIT_PATH_PARAMETERS; p++)
        result->value[p] = law_.exists(p) ? value_[std::size_t(p)] : std::nan("");
    result->free_exponent = std::nan("");
    if (options_.contact.rheology.kind == NT_RHEOLOGY_POWER_LAW) {
        result->free_exponent = value_[1];
        const auto place = std::find(free_.begin(), free_.end(), 1);
        if (place != free_.end() && at_floor(1))
            result->free_exponent = std::min(0.0, step(0.0, false)[place - free_.begin()]);
    }
    write_shape(result);
    result->iterations = iterations_;
    result->converged = converged_;
    result->held = held_;
}

namespace
{

// Drag and level cannot be told apart where the base moves one way only.
unsigned held_of(const nt_fit_path_options &options, const PathBins &bins)
{
    double low = 0.0, high = 0.0;
    for (std::size_t i = 0; i < bins.size(); i++)
        if (bins.count[i] > 0.0) {
            low = std::min(low, bins.speed[i]);
            high = std::max(high, bins.speed[i]);
        }
    return options.held | (low < -opposite * high ? 0U : 1U << NT_FIT_PATH_DRAG);
}

nt_status fit_path(const nt_fit_path_options &options, const nt_fit_path &path, nt_fit_path_result *result,
                   nt_problem *problem)
{
    const std::vector<double> position = steady_positions(path);
    PathSpan span;
    nt_status status = guess_span(options, path, position, &span);
    if (status != NT_OK)
        return status;
    const PathBins bins = bin_path(path, position, span);
    std::vector<PathValues> starts;
    status = guess_path(options, bins, span, &starts, problem);
    if (status != NT_OK)
        return status;
    double best = infinity;
    status = NT_E_NO_CONVERGENCE;
    for (const PathValues &start : starts) {
        PathFit fit(options, bins, held_of(options, bins));
        const nt_status found = fit.run(start);
        if (found == NT_OK && fit.cost() < best) {
            best = fit.cost();
            fit.write(result);
            status = NT_OK;
        }
        if (status == NT_OK && result->converged && best < good_enough * double(result->bins))
            break;
    }
    return status;
}

} // namespace

} // namespace nanotouch

nt_fit_path_options nt_fit_path_defaults(void)
{
    nt_fit_path_options options{};
    options.contact = nt_viscoelastic_defaults();
    for (double &start : options.start)
        start = std::nan("");
    options.start[NT_FIT_PATH_LEVEL] = options.start[NT_FIT_PATH_TILT] = options.start[NT_FIT_PATH_DRAG] = 0.0;
    options.max_iterations = 60;
    return options;
}

nt_status nt_fit_path_model(const nt_fit_path_options *options, const nt_fit_path_result *found,
                            const nt_fit_path *path, double *forces, double *indentations)
{
    nt_status status = nanotouch::check_path(*options, *path, nullptr);
    if (status != NT_OK)
        return status;
    try {
        const nanotouch::PathBins bins = nanotouch::all_points(*path, nanotouch::steady_positions(*path));
        nanotouch::PathLaw law(*options, bins);
        nanotouch::PathValues value;
        std::copy_n(found->value, NT_FIT_PATH_PARAMETERS, value.begin());
        nt_viscoelastic_result result{};
        status = law.evaluate(value, nullptr, &result);
        if (status == NT_OK && forces)
            std::copy(law.force.begin(), law.force.end(), forces);
        if (status == NT_OK && indentations)
            std::copy(law.indentation.begin(), law.indentation.end(), indentations);
        return status;
    } catch (const std::bad_alloc &) {
        return NT_E_NO_MEMORY;
    }
}

nt_status nt_fit_path_run(const nt_fit_path_options *options, const nt_fit_path *path, nt_fit_path_result *result,
                          nt_problem *problem)
{
    nt_status status = nanotouch::check_path(*options, *path, problem);
    if (status != NT_OK)
        return status;
    try {
        return nanotouch::fit_path(*options, *path, result, problem);
    } catch (const std::bad_alloc &) {
        return NT_E_NO_MEMORY;
    } catch (...) {
        return NT_E_NO_CONVERGENCE;
    }
}
