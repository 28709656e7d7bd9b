// SPDX-License-Identifier: BSD-3-Clause
// The model of fit.h with its derivatives; private to fit/.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "nanotouch/fit.h"

namespace nanotouch
{

using Parameters = std::array<double, NT_FIT_PARAMETERS>;

// Positive quantities are fitted by their logarithm, so that their scale does not matter and they cannot change sign.
bool is_logarithmic(const nt_fit_options &options, int parameter);
bool is_free(const nt_fit_options &options, int parameter);

// Force as measured, and its derivatives by ln(parameter) where that is_logarithmic, else by the parameter.
struct Point {
    double force;
    double indentation;
    Parameters gradient;
    bool held;
};

// Many of them, an array each.
struct Points {
    std::vector<double> force, indentation;
    std::array<std::vector<double>, NT_FIT_PARAMETERS> gradient;
    std::vector<char> held;
    std::size_t size() const
    {
        return force.size();
    }
    void resize(std::size_t count);
    void set(std::size_t i, const Point &point);
};

// Position of the base at which the tip is torn off, and its derivatives.
struct Tear {
    double position;
    Parameters gradient;
    double steep; // how far before it the model is only a straight continuation [m]
};

class Model
{
  public:
    static std::unique_ptr<Model> make(const nt_fit_options &options);
    virtual ~Model() = default;

    // Makes the law ready for the given values (SI); NT_E_RANGE where it does not exist.
    virtual nt_status prepare(const Parameters &value) = 0;

    // The model at the position of every point.
    virtual nt_status points_at(const nt_fit_data &data, Points *points) const = 0;

    // NT_E_UNSUPPORTED for a law without adhesion.
    virtual nt_status tear(Tear *tear) const = 0;

    // delta + F/k_c at a (true) force on the stable branch: how far the base has travelled since first touch.
    virtual nt_status travel(double force, double *travel) const = 0;

    // Those parts of the result that only the law knows.
    virtual void describe(double deepest, nt_fit_result *result) const = 0;
};

} // namespace nanotouch
