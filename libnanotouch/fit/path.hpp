// SPDX-License-Identifier: BSD-3-Clause
// A whole curve over time, binned, and the model on it; private to fit/.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <vector>

#include "nanotouch/fit.h"

namespace nanotouch
{

using PathValues = std::array<double, NT_FIT_PATH_PARAMETERS>;

// Nodes of the path; those that are fitted have a weight.
struct PathBins {
    std::vector<double> time, position, speed, force;
    std::vector<double> count; // points that a node's force is the mean of; 0: on the path alone
    std::vector<long> first;   // node of each segment
    std::size_t size() const
    {
        return time.size();
    }
};

// Where the force is known to be that of the free lever; elsewhere bins are narrow.
struct PathSpan {
    double first_touch; // [m]
    double depth;       // from first touch to the deepest position [m]
};

// NT_OK, or what is wrong with the arguments.
nt_status check_path(const nt_fit_path_options &options, const nt_fit_path &path, nt_problem *problem);
// Positions that go one way within a movement, however the sensor's noise jitters.
std::vector<double> steady_positions(const nt_fit_path &path);
PathBins bin_path(const nt_fit_path &path, const std::vector<double> &position, const PathSpan &span);
// Every point is a node.
PathBins all_points(const nt_fit_path &path, const std::vector<double> &position);

// Where first touch seems to be, from the approach alone.
nt_status guess_span(const nt_fit_path_options &options, const nt_fit_path &path, const std::vector<double> &position,
                     PathSpan *span);
// Where fits begin: one or more.
nt_status guess_path(const nt_fit_path_options &options, const PathBins &bins, const PathSpan &span,
                     std::vector<PathValues> *starts, nt_problem *problem);

// Which parameters there are, and how each is varied.
class PathLaw
{
  public:
    PathLaw(const nt_fit_path_options &options, const PathBins &bins);
    int own() const // of the rheology
    {
        return own_;
    }
    bool exists(int parameter) const
    {
        return parameter < own_ || parameter >= NT_RHEOLOGY_PARAMETERS;
    }
    bool is_logarithmic(int parameter) const
    {
        return parameter < own_ && !is_exponent(parameter);
    }
    bool is_exponent(int parameter) const
    {
        return parameter == 1 && options_.contact.rheology.kind == NT_RHEOLOGY_POWER_LAW;
    }
    nt_viscoelastic contact(const PathValues &value) const;
    // Force with level, tilt and drag at every node, and its derivatives by the parameters in free, in SI.
    nt_status evaluate(const PathValues &value, const std::vector<int> *free, nt_viscoelastic_result *result);

    std::vector<double> force, contact_force, indentation;
    Eigen::MatrixXd jacobian;

  private:
    double drag_part(std::size_t node, double first_touch) const;

    const nt_fit_path_options &options_;
    const PathBins &bins_;
    int own_;
    std::vector<double> derivatives_, workspace_;
};

} // namespace nanotouch
