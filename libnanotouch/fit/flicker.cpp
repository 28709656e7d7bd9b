// SPDX-License-Identifier: BSD-3-Clause
// Half the mean squared difference of neighbouring means of m points is the Allan variance, w/m of white noise and a
// constant of flicker noise, which no number of points averages away. Both are fitted to the octaves of m by maximum
// likelihood (for Gaussian noise each difference is one draw), coarse ones only: in fine ones the electronics have
// their say.
#include "flicker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nanotouch
{

namespace
{

constexpr std::size_t finest = 8; // points of a mean: what is smeared over fewer counts as white
constexpr std::size_t fewest = 4; // differences of an octave
constexpr std::size_t most_octaves = 5;
constexpr double evident = 1.0;     // gain in ln L: white noise passes for flicker once in 20 to 30 records
constexpr double of_the_mean = 0.6; // variance of a mean over Allan's, of flicker noise about a line
constexpr double least_ratio = 1e-3, most_ratio = 1e3;
constexpr int ratios = 121;

struct Octave {
    double size, count, variance; // points of a mean, differences, size times the Allan variance [N^2]
};

std::vector<Octave> octaves_of(std::vector<double> means)
{
    std::vector<Octave> octaves;
    for (std::size_t size = 1; means.size() >= 2 * fewest; size *= 2) {
        const std::size_t count = means.size() / 2;
        double squares = 0.0;
        for (std::size_t i = 0; i < count; i++) {
            const double one = means[2 * i], other = means[2 * i + 1];
            squares += (one - other) * (one - other);
            means[i] = 0.5 * (one + other);
        }
        means.resize(count);
        if (size >= finest)
            octaves.push_back({double(size), double(count), 0.5 * double(size) * squares / double(count)});
    }
    if (octaves.size() > most_octaves)
        octaves.erase(octaves.begin(), octaves.end() - static_cast<std::ptrdiff_t>(most_octaves));
    return octaves;
}

// The likeliest white variance at a ratio of flicker to white in the first octave, and its ln L.
struct Likely {
    double white, likelihood;
};

Likely likely(const std::vector<Octave> &octaves, double ratio)
{
    double sum = 0.0, counts = 0.0, logarithms = 0.0;
    for (const Octave &octave : octaves) {
        const double shape = 1.0 + ratio * octave.size / octaves.front().size;
        sum += octave.count * octave.variance / shape;
        counts += octave.count;
        logarithms += octave.count * std::log(shape);
    }
    const double white = sum / counts;
    return {white, -0.5 * (counts * std::log(white) + logarithms)};
}

} // namespace

Noise split_noise(const std::vector<double> &rest, double scatter)
{
    const std::vector<Octave> octaves = octaves_of(rest);
    Noise noise{scatter * scatter, 0.0};
    if (octaves.size() < 2)
        return noise;
    const Likely alone = likely(octaves, 0.0);
    Likely best = alone;
    double best_ratio = 0.0;
    for (int i = 0; i < ratios; i++) {
        const double ratio = least_ratio * std::pow(most_ratio / least_ratio, double(i) / (ratios - 1));
        const Likely found = likely(octaves, ratio);
        if (found.likelihood > best.likelihood) {
            best = found;
            best_ratio = ratio;
        }
    }
    if (!(best.likelihood - alone.likelihood > evident)) {
        best = alone;
        best_ratio = 0.0;
    }
    noise.white = std::max(noise.white, best.white);
    noise.flicker = of_the_mean * best.white * best_ratio / octaves.front().size;
    return noise;
}

} // namespace nanotouch
