// SPDX-License-Identifier: BSD-3-Clause
// F = E* g(X - delta0) + F0 + G (X - X_b), by orthogonalising its columns: a thousand curves in a tenth of a second
// need no iteration.
#include "linear.hpp"

#include <Eigen/Dense>

#include <cmath>
#include <vector>

#include "fit/models/row.h"

namespace nanotouch
{

namespace
{

constexpr double smallest_column = 1e-12; // of the largest: below, something free has no influence

bool is_linear(const nt_fit_options &options)
{
    const bool model = options.model != NT_FIT_CUSTOM && nt_fit_row_of(options.model)->shape;
    bool data = options.tear_sigma > 0.0;
    for (const nt_fit_start &start : options.parameter)
        data = data || (start.sigma > 0.0 && !start.fixed);
    return model && !data && options.spring_constant == 0.0 && options.loss == NT_LOSS_SQUARES &&
           options.parameter[NT_FIT_CONTACT_POINT].fixed && !options.parameter[NT_FIT_EFFECTIVE_MODULUS].fixed;
}

std::vector<int> free_ones(const nt_fit_options &options)
{
    std::vector<int> free{NT_FIT_EFFECTIVE_MODULUS};
    for (const int background : {NT_FIT_FORCE_OFFSET, NT_FIT_FORCE_TILT})
        if (is_free(options, background))
            free.push_back(background);
    return free;
}

// The columns of the free parameters, and beside them what they have to add up to.
Eigen::MatrixXd design_of(const nt_fit_options &options, const nt_fit_data &data, const std::vector<int> &free)
{
    const auto held = [&](int p) { return is_free(options, p) ? 0.0 : options.parameter[p].initial; };
    const double offset = held(NT_FIT_FORCE_OFFSET), tilt = held(NT_FIT_FORCE_TILT);
    const double zero = options.parameter[NT_FIT_CONTACT_POINT].initial;
    const nt_fit_row *row = nt_fit_row_of(options.model);
    Parameters one; // Pa
    for (std::size_t p = 0; p < one.size(); p++)
        one[p] = p == NT_FIT_EFFECTIVE_MODULUS ? 1.0 : options.parameter[p].initial;
    nt_fit_branch branch;
    (void)row->prepare(&options, one.data(), &branch);
    const auto columns = static_cast<Eigen::Index>(free.size());
    Eigen::MatrixXd design(data.count, columns + 1);
    for (long i = 0; i < data.count; i++) {
        const double X = data.position[i * data.position_stride], from = X - options.tilt_position;
        design(i, 0) = X > zero ? row->shape(&branch, X - zero) : 0.0;
        for (Eigen::Index j = 1; j < columns; j++)
            design(i, j) = free[static_cast<std::size_t>(j)] == NT_FIT_FORCE_OFFSET ? 1.0 : from;
        design(i, columns) = data.force[i * data.force_stride] - offset - tilt * from;
    }
    return design;
}

} // namespace

bool solve_linear(const nt_fit_options &options, const nt_fit_data &data, Parameters *value)
{
    if (!is_linear(options))
        return false;
    const std::vector<int> free = free_ones(options);
    const auto columns = static_cast<Eigen::Index>(free.size());
    Eigen::MatrixXd design = design_of(options, data, free);
    const Eigen::RowVectorXd norms = design.colwise().norm();
    if (!(norms.minCoeff() > 0.0))
        return false;
    design.array().rowwise() /= norms.array();
    const Eigen::MatrixXd normal = design.transpose() * design;
    const Eigen::LDLT<Eigen::MatrixXd> solver(normal.topLeftCorner(columns, columns));
    if (!(solver.rcond() > smallest_column))
        return false;
    const Eigen::VectorXd solved = solver.solve(normal.topRightCorner(columns, 1)) * norms(columns);
    for (int i = 0; i < NT_FIT_PARAMETERS; i++)
        (*value)[static_cast<std::size_t>(i)] = options.parameter[i].initial;
    for (Eigen::Index j = 0; j < columns; j++) {
        const int p = free[static_cast<std::size_t>(j)];
        const double found = solved(j) / norms(j);
        if (!(found >= options.parameter[p].minimum && found <= options.parameter[p].maximum))
            return false;
        (*value)[static_cast<std::size_t>(p)] = found;
    }
    return true;
}

} // namespace nanotouch
