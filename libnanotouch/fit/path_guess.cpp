// SPDX-License-Identifier: BSD-3-Clause
// Where fits of a whole curve begin: the contact point as the foot of F^(1/n) on the approach, the modulus as that of
// an elastic contact with the same peak.
#include <algorithm>
#include <cmath>

#include "path.hpp"

namespace nanotouch
{

namespace
{

constexpr long parts = 800;   // of an approach that are looked at
constexpr double least = 6.0; // peak over the noise of a part
constexpr double free_part = 0.1;
constexpr std::array levels{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9}; // of the peak
constexpr std::array exponents{0.1, 0.4};                                 // of a power law
constexpr std::array quickness{0.1, 1.0};                                 // relaxation times over the time of contact
constexpr double relaxed = 0.6, relaxing = 0.8;                           // E_inf and the sum of E_k over E*

double power_of(nt_shape_kind kind)
{
    return kind == NT_SHAPE_CONE ? 2.0 : kind == NT_SHAPE_PUNCH ? 1.0 : 1.5;
}

// Means of neighbours on the way to the deepest position of the first movement.
struct Approach {
    std::vector<double> position, force;
    double noise;
};

Approach approach_of(const nt_fit_path_options &options, const nt_fit_path &path, const std::vector<double> &position)
{
    const auto last = path.segments > 1 ? position.begin() + path.starts[1] : position.end();
    const long deepest = std::max_element(position.begin(), last) - position.begin();
    const long size = std::max<long>(1, (deepest + 1) / parts);
    Approach approach{{}, {}, options.noise / std::sqrt(double(size))};
    for (long i = 0; i + size <= deepest + 1; i += size) {
        double place = 0.0, force = 0.0;
        for (long j = i; j < i + size; j++) {
            place += position[std::size_t(j)] / double(size);
            force += path.forces[j] / double(size);
        }
        approach.position.push_back(place);
        approach.force.push_back(force);
    }
    return approach;
}

double start_or(double start, double guessed)
{
    return std::isnan(start) ? guessed : start;
}

// The force of an elastic contact of 1 Pa; a problem where the law does not reach so deep.
nt_status unit_force(nt_viscoelastic contact, double indentation, double *force, nt_problem *problem)
{
    contact.rheology = nt_rheology_defaults();
    contact.rheology.modulus = 1.0;
    contact.rheology.exponent = 0.0;
    contact.spring_constant = 0.0;
    const double times[2] = {0.0, 1.0}, positions[2] = {0.0, indentation};
    double forces[2] = {0.0, 0.0};
    std::vector<double> workspace(std::size_t(nt_viscoelastic_workspace(&contact, 2, 0)));
    const nt_viscoelastic_path path = {times, positions, 0.0, 2, workspace.data()};
    nt_viscoelastic_result result{};
    result.forces = forces;
    const nt_status status = nt_viscoelastic_run(&contact, &path, &result, problem);
    *force = forces[1];
    return status == NT_OK && !(*force > 0.0) ? NT_E_NO_CONVERGENCE : status;
}

void start_solid(const nt_rheology &kind, double modulus, double time, PathValues *value)
{
    const int arms = kind.kind == NT_RHEOLOGY_PRONY ? kind.arm_count : 1;
    (*value)[0] = relaxed * modulus;
    for (int k = 0; k < arms; k++) {
        (*value)[std::size_t(1 + 2 * k)] = relaxing * modulus / arms;
        (*value)[std::size_t(2 + 2 * k)] = time * std::pow(10.0, arms > 1 ? 2.0 * k / (arms - 1) - 1.0 : 0.0);
    }
}

} // namespace

nt_status guess_span(const nt_fit_path_options &options, const nt_fit_path &path, const std::vector<double> &position,
                     PathSpan *span)
{
    const Approach approach = approach_of(options, path, position);
    const std::size_t count = approach.force.size();
    const double deepest = *std::max_element(position.begin(), position.end());
    const double given = options.start[NT_FIT_PATH_CONTACT];
    if (!std::isnan(given)) {
        *span = {given, deepest - given};
        return given < deepest ? NT_OK : NT_E_NO_CONVERGENCE;
    }
    if (count < levels.size())
        return NT_E_NO_CONVERGENCE;
    double level = 0.0;
    const std::size_t free = std::max<std::size_t>(1, std::size_t(free_part * double(count)));
    for (std::size_t i = 0; i < free; i++)
        level += approach.force[i] / double(free);
    const std::size_t top =
        std::size_t(std::max_element(approach.force.begin(), approach.force.end()) - approach.force.begin());
    const double peak = approach.force[top] - level;
    if (!(peak > least * approach.noise))
        return NT_E_NO_CONVERGENCE;
    const double power = power_of(options.contact.shape.kind);
    const double softness = options.contact.spring_constant > 0.0 ? 1.0 / options.contact.spring_constant : 0.0;
    Eigen::Matrix2d square = Eigen::Matrix2d::Zero();
    Eigen::Vector2d product = Eigen::Vector2d::Zero();
    for (const double part : levels) { // depth = first touch + slope F^(1/n)
        std::size_t i = top;
        while (i > 0 && approach.force[i] - level > part * peak)
            i--;
        const Eigen::Vector2d row(1.0, std::pow(std::max(approach.force[i] - level, 0.0) / peak, 1.0 / power));
        square += row * row.transpose();
        product += row * (approach.position[i] - softness * (approach.force[i] - level) - deepest);
    }
    const double foot = deepest + square.ldlt().solve(product)[0];
    const double first = std::clamp(foot, approach.position[0], approach.position[top]);
    *span = {first, deepest - first};
    return first < deepest ? NT_OK : NT_E_NO_CONVERGENCE;
}

nt_status guess_path(const nt_fit_path_options &options, const PathBins &bins, const PathSpan &span,
                     std::vector<PathValues> *starts, nt_problem *problem)
{
    const nt_viscoelastic &contact = options.contact;
    const std::size_t top = std::size_t(std::max_element(bins.force.begin(), bins.force.end()) - bins.force.begin());
    std::size_t touch = 0;
    while (touch < top && bins.position[touch] < span.first_touch)
        touch++;
    const double time = std::max(bins.time[top] - bins.time[touch], bins.time[1] - bins.time[0]);
    const double softness = contact.spring_constant > 0.0 ? 1.0 / contact.spring_constant : 0.0;
    const double peak = bins.force[top], depth = bins.position[top] - span.first_touch - softness * peak;
    double unit;
    const nt_status status = unit_force(contact, depth > 0.0 ? depth : 0.1 * span.depth, &unit, problem);
    if (status != NT_OK)
        return status;
    const double modulus = peak / unit, reference = contact.rheology.reference_time;
    const bool power_law = contact.rheology.kind == NT_RHEOLOGY_POWER_LAW;
    for (std::size_t i = 0; i < 2; i++) {
        PathValues value;
        std::copy_n(options.start, NT_FIT_PATH_PARAMETERS, value.begin());
        PathValues guess = value;
        if (power_law) {
            guess[1] = start_or(value[1], exponents[i]);
            guess[0] = modulus * std::pow(time / reference, guess[1]);
        } else {
            start_solid(contact.rheology, modulus, quickness[i] * time, &guess);
        }
        guess[NT_FIT_PATH_CONTACT] = span.first_touch;
        for (std::size_t p = 0; p < value.size(); p++)
            value[p] = start_or(value[p], guess[p]);
        starts->push_back(value);
    }
    return NT_OK;
}

} // namespace nanotouch
