// SPDX-License-Identifier: BSD-3-Clause
// What follows from a solution by fitting again: how it moves with what is calibrated, and how far a parameter that the
// points do not determine can go before the fit gets worse.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <new>
#include <vector>

#include "internal/fit.h"
#include "model.hpp"
#include "solving.hpp"

namespace nanotouch
{

namespace
{

constexpr double excess = 3.841458820694124; // of chi^2 at 95 %, one parameter
constexpr int halvings = 8;                  // of a decade: to 1 %
constexpr double step = 1e-3;                // relative, of what is calibrated
constexpr double infinity = std::numeric_limits<double>::infinity();

bool is_usable(const nt_fit_solution *solution, const nt_fit_data *data)
{
    return solution && data && data->position && data->force && solution->count > 0 && solution->count <= data->count;
}

// chi^2 over one parameter, the others fitted; remembers what it has seen.
class Profile
{
  public:
    Profile(const nt_fit_solution &solution, const nt_fit_data &data, nt_fit_parameter parameter);
    double at(double value);
    double best() const;
    double clip(double value) const
    {
        return std::clamp(value, start_.minimum, start_.maximum);
    }
    // Where chi^2 has risen by what 95 % allow, in steps of a factor; `beyond` where it does not up to the limit.
    double end(double factor, double beyond);

  private:
    nt_fit_options options_;
    nt_fit_data data_;
    nt_fit_start &start_; // of options_
    std::map<double, double> seen_;
};

Profile::Profile(const nt_fit_solution &solution, const nt_fit_data &data, nt_fit_parameter parameter)
    : options_(solution.options), data_(data), start_(options_.parameter[parameter])
{
    data_.count = solution.count;
    start_.fixed = 1;
}

double Profile::at(double value)
{
    const auto [found, is_new] = seen_.try_emplace(value, infinity);
    if (is_new) {
        start_.initial = value;
        nt_fit_result fit;
        if (nt_fit_run(&options_, &data_, &fit, nullptr) == NT_OK)
            found->second = fit.chi_square;
    }
    return found->second;
}

double Profile::best() const
{
    const auto lower = [](const auto &a, const auto &b) { return a.second < b.second; };
    return std::min_element(seen_.begin(), seen_.end(), lower)->first;
}

double Profile::end(double factor, double beyond)
{
    double inside = best();
    const double most = at(inside) + excess, limit = factor > 1.0 ? start_.maximum : start_.minimum;
    const auto within = [&](double value) { return factor > 1.0 ? value < limit : value > limit; };
    while (within(inside * factor) && at(inside * factor) <= most)
        inside *= factor;
    if (!within(inside * factor))
        return beyond;
    double outside = inside * factor;
    for (int i = 0; i < halvings; i++) {
        const double middle = std::sqrt(inside * outside);
        (at(middle) > most ? outside : inside) = middle;
    }
    return outside;
}

// The same fit with what is calibrated changed by a step, 0 for none.
nt_fit_options changed_options(const nt_fit_solution &solution, nt_fit_calibration changed, double by)
{
    nt_fit_options options = solution.options;
    for (int i = 0; i <= NT_FIT_CONTACT_POINT; i++)
        if (is_free(options, i)) {
            nt_fit_start &start = options.parameter[i];
            start.initial = std::clamp(solution.fit.value[i], start.minimum, start.maximum);
        }
    if (changed == NT_FIT_HALF_ANGLE) {
        options.half_angle += by;
    } else if (changed == NT_FIT_RADIUS) {
        options.radius *= 1.0 + by;
    } else if (changed == NT_FIT_THICKNESS) {
        nt_fit_start &thickness = options.parameter[NT_FIT_FOURTH];
        thickness.initial = std::min(thickness.initial * (1.0 + by), thickness.maximum);
    } else {
        options.spring_constant *= 1.0 + by;
        options.force_noise *= 1.0 + by;
        for (const int background : {NT_FIT_FORCE_OFFSET, NT_FIT_FORCE_TILT})
            options.parameter[background].sigma *= 1.0 + by;
    }
    return options;
}

// And every force with it where that changes them.
nt_status fit_changed(const nt_fit_solution &solution, nt_fit_data data, nt_fit_calibration changed, double by,
                      nt_fit_result *fit)
{
    const nt_fit_options options = changed_options(solution, changed, by);
    const double scale = changed == NT_FIT_SPRING_CONSTANT ? 1.0 + by : 1.0;
    data.count = solution.count;
    std::vector<double> force(static_cast<std::size_t>(data.count));
    for (long i = 0; i < data.count; i++)
        force[static_cast<std::size_t>(i)] = scale * data.force[i * data.force_stride];
    data.force = force.data();
    data.force_stride = 1;
    return nt_fit_run(&options, &data, fit, nullptr);
}

// The solution itself is not exact enough for differences.
nt_status shift(const nt_fit_solution &solution, const nt_fit_data &data, nt_fit_calibration changed, double *moved)
{
    nt_fit_result fit, with;
    nt_status status = fit_changed(solution, data, changed, 0.0, &fit);
    if (status == NT_OK)
        status = fit_changed(solution, data, changed, step, &with);
    for (int i = 0; i < NT_FIT_PARAMETERS && status == NT_OK; i++)
        moved[i] = (with.value[i] - fit.value[i]) / step;
    return status;
}

} // namespace

bool asks(const nt_fit_options &options, nt_fit_parameter place, const char *name)
{
    const nt_fit_quantity quantity = nt_fit_quantity_of(&options, place);
    return quantity.name && !std::strcmp(quantity.name, name) && !options.parameter[place].fixed;
}

void Solving::doubt_adhesion()
{
    const nt_fit_options &options = solution_.options;
    nt_fit_result &fit = solution_.fit;
    if (!asks(options, NT_FIT_WORK_OF_ADHESION, "work_of_adhesion") || !fit.identifiable[NT_FIT_WORK_OF_ADHESION] ||
        options.tear_sigma > 0.0 || is_exact())
        return;
    Profile profile(solution_, data_, NT_FIT_WORK_OF_ADHESION);
    const double fitted = profile.clip(fit.value[NT_FIT_WORK_OF_ADHESION]);
    fit.identifiable[NT_FIT_WORK_OF_ADHESION] =
        profile.at(profile.clip(0.1 * fitted)) > profile.at(fitted) + 2.0 * excess;
}

} // namespace nanotouch

nt_status nt_fit_shift(const nt_fit_solution *solution, const nt_fit_data *data, nt_fit_calibration changed,
                       double shift[NT_FIT_PARAMETERS])
{
    if (!nanotouch::is_usable(solution, data) || !shift)
        return NT_E_ARGUMENT;
    try {
        return nanotouch::shift(*solution, *data, changed, shift);
    } catch (...) {
        return NT_E_NO_MEMORY;
    }
}

nt_status nt_fit_bounds(const nt_fit_solution *solution, const nt_fit_data *data, nt_fit_parameter parameter,
                        double bounds[2])
{
    if (!nanotouch::is_usable(solution, data) || !bounds || !nanotouch::is_logarithmic(solution->options, parameter) ||
        solution->options.force_noise == 0.0)
        return NT_E_ARGUMENT;
    try {
        nanotouch::Profile profile(*solution, *data, parameter);
        const double fitted = profile.clip(solution->fit.value[parameter]);
        for (int decade = -2; decade <= 2; decade++) // where the parameter hardly matters the best is anywhere
            profile.at(profile.clip(fitted * std::pow(10.0, decade)));
        bounds[0] = profile.end(0.1, 0.0);
        bounds[1] = profile.end(10.0, nanotouch::infinity);
        return NT_OK;
    } catch (...) {
        return NT_E_NO_MEMORY;
    }
}
