// SPDX-License-Identifier: BSD-3-Clause
// The least-squares problem as Ceres sees it; private to fit/.
#pragma once

#include <ceres/ceres.h>
#include <ceres/tiny_solver.h>

#include <deque>
#include <vector>

#include "model.hpp"

namespace nanotouch
{

// Free parameters as numbers of order one, all 0 at the start: value = start exp(x), or start + scale x.
class Coordinates
{
  public:
    Coordinates(const nt_fit_options &options, const nt_fit_data &data, const Parameters &start);
    int size() const
    {
        return static_cast<int>(free_.size());
    }
    int parameter(int i) const
    {
        return free_[static_cast<std::size_t>(i)];
    }
    Parameters values(const double *x) const;
    double inverse(int i, double value) const;
    double slope(int i, const Parameters &value) const; // d value/d x
    double gradient_scale(int i) const;                 // what Model's gradient is multiplied by
    bool is_logarithmic(int i) const
    {
        return logarithmic_[static_cast<std::size_t>(parameter(i))];
    }

  private:
    std::vector<int> free_;
    std::array<bool, NT_FIT_PARAMETERS> logarithmic_;
    Parameters start_, scale_;
};

// Evaluates all residuals and derivatives together, once per point of the search: preparing a law costs more than using
// it.
class Residuals : public ceres::EvaluationCallback
{
  public:
    Residuals(const nt_fit_options &options, const nt_fit_data &data, const Coordinates &coordinates);
    void PrepareForEvaluation(bool evaluate_jacobians, bool new_evaluation_point) override;

    double *x()
    {
        return x_.data();
    }
    void weigh(double unit);       // as if it had been the unit of the data's residuals from the beginning
    bool move_to(const double *x); // false where they are not valid there
    bool valid() const
    {
        return valid_;
    }
    long count() const
    {
        return count_;
    } // of residuals
    int size() const
    {
        return coordinates_.size();
    }
    long data_count() const
    {
        return data_.count;
    } // the first of them; the rest are the tear and what is known of parameters
    double unit() const
    {
        return unit_;
    } // of the data's residuals [N]
    const double *residuals(long first) const
    {
        return &residual_[static_cast<std::size_t>(first)];
    }
    double residual(long i) const
    {
        return *residuals(i);
    }
    double sum_of_squares() const;
    using Columns = Eigen::Map<const Eigen::MatrixXd>;
    Columns jacobian() const
    {
        return {gradient_.data(), count_, size()};
    } // a row for each residual
    bool met_bound() const
    {
        return met_bound_;
    } // since bounds were made walls
    void make_bounds_walls(bool walls);
    bool has_tear() const
    {
        return options_.tear_sigma > 0.0;
    } // then it is the residual data_count()
    const Model &model() const
    {
        return *model_;
    }
    const Points &points() const
    {
        return points_;
    } // of the data, where the residuals are valid
    Parameters values() const
    {
        return coordinates_.values(x_.data());
    }

  private:
    bool evaluate();
    bool is_outside() const;
    void store_points();
    bool store_tear(long i);
    void store_known(long i, int coordinate);
    double *column(int coordinate)
    {
        return &gradient_[static_cast<std::size_t>(coordinate * count_)];
    }

    const nt_fit_options &options_;
    const nt_fit_data &data_;
    const Coordinates &coordinates_;
    const std::unique_ptr<Model> model_;
    double unit_;
    std::vector<double> factor_; // of each coordinate's gradient, of the points
    long count_ = 0;
    std::vector<double> x_, seen_; // seen: where the residuals are those of
    std::vector<double> residual_, gradient_, lowest_, highest_;
    Points points_;
    std::vector<int> known_; // coordinates with a datum of their own
    bool valid_ = false, is_seen_ = false, walls_ = false, met_bound_ = false;
};

// All of Residuals as Ceres' small solver sees them: as few as there are parameters, and one, which have the same
// normal equations and the same sum of squares.
struct Squares {
    using Scalar = double;
    enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = Eigen::Dynamic };
    Residuals &all;
    int NumResiduals() const
    {
        return all.size() + 1;
    }
    int NumParameters() const
    {
        return all.size();
    }
    bool operator()(const double *x, double *residuals, double *jacobian) const; // by columns
};

// Some of Residuals as one block: a single point where a loss acts on each, all of them where none does.
class Residual : public ceres::CostFunction
{
  public:
    Residual(const Residuals &all, long first, long count, int parameters);
    bool Evaluate(double const *const *, double *residuals, double **jacobians) const override;

  private:
    const Residuals &all_;
    const long first_;
};

} // namespace nanotouch
