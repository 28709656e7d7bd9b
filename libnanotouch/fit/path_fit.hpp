// SPDX-License-Identifier: BSD-3-Clause
// Least squares on a binned curve over time; private to fit/.
#pragma once

#include <limits>

#include "path.hpp"

namespace nanotouch
{

constexpr double infinity = std::numeric_limits<double>::infinity();

class PathFit
{
  public:
    PathFit(const nt_fit_path_options &options, const PathBins &bins, unsigned held)
        : options_(options), bins_(bins), law_(options, bins), held_(held)
    {
        for (int p = 0; p < NT_FIT_PATH_PARAMETERS; p++)
            if (law_.exists(p) && !(held >> p & 1U))
                free_.push_back(p);
    }
    nt_status run(const PathValues &start);
    void write(nt_fit_path_result *result);
    double cost() const
    {
        return cost_;
    }

  private:
    nt_status look(const PathValues &value, bool with_slopes, double *cost);
    bool at_floor(int parameter) const
    {
        return law_.is_exponent(parameter) && value_[std::size_t(parameter)] <= 0.0;
    }
    void make_equations();
    Eigen::VectorXd step(double damping, bool hold_floor) const;
    PathValues moved(const Eigen::VectorXd &step) const;
    double scale(int parameter) const
    {
        return law_.is_logarithmic(parameter) ? value_[std::size_t(parameter)] : 1.0;
    }
    void write_sigmas(double factor, nt_fit_path_result *result) const;
    void write_shape(nt_fit_path_result *result) const;
    long weighed() const;

    const nt_fit_path_options &options_;
    const PathBins &bins_;
    PathLaw law_;
    unsigned held_;
    std::vector<int> free_;
    PathValues value_{};
    double cost_ = infinity;
    nt_viscoelastic_result seen_{};
    Eigen::MatrixXd square_;  // J^T W J by the varied numbers
    Eigen::VectorXd product_; // J^T W r
    int iterations_ = 0;
    bool converged_ = false;
};

} // namespace nanotouch
