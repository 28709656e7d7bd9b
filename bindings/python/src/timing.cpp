// SPDX-License-Identifier: BSD-3-Clause
// timing.h, hal_linux.h: what this machine keeps
#include <chrono>
#include <memory>
#include <string>

#include "hal.h"
#include "internal/timing.h"
#include "nanotouch/advanced/hal_linux.h"
#include "nanotouch/advanced/timing.h"

static py::dict histogram_of(const nt_histogram &histogram)
{
    py::list edges, counts;
    for (int i = 0; i < NT_HISTOGRAM_BUCKETS; ++i)
        if (histogram.counts[i] > 0) {
            edges.append(1e-9 * static_cast<double>(nt_histogram_edge(i)));
            counts.append(histogram.counts[i]);
        }
    py::dict found;
    found["edges"] = edges;
    found["counts"] = counts;
    for (const double share : {0.5, 0.99, 0.999, 0.9999})
        found[py::float_(share)] = 1e-9 * static_cast<double>(nt_histogram_quantile(&histogram, share));
    found["most"] = 1e-9 * static_cast<double>(histogram.most);
    return found;
}

static int stop_when_asked(void *context, uint64_t, double)
{
    auto &due = *static_cast<std::chrono::steady_clock::time_point *>(context);
    const auto now = std::chrono::steady_clock::now();
    if (now < due)
        return 0;
    due = now + std::chrono::milliseconds(200);
    const py::gil_scoped_acquire gil; // five times a second: Ctrl-C is heard
    return PyErr_CheckSignals();
}

static py::dict latency(double period, uint64_t ticks, int priority, int processor)
{
    nt_realtime_wish wish = nt_realtime_wish_defaults();
    wish.priority = priority;
    wish.processor = processor;
    wish.locks = wish.stays_awake = priority > 0;
    nt_realtime realtime{};
    auto timing = std::make_unique<nt_timing>();
    auto due = std::chrono::steady_clock::now();
    const nt_loop_phases phases = {stop_when_asked, nullptr, nullptr, &due};
    nt_status granted, status = NT_OK;
    {
        const py::gil_scoped_release release;
        granted = nt_realtime_begin(&realtime, &wish);
        if (granted == NT_OK)
            status = nt_loop_run_timed(period, ticks, &phases, timing.get());
        nt_realtime_end(granted == NT_OK ? &realtime : nullptr);
    }
    if (PyErr_Occurred())
        throw py::error_already_set();
    raise_on(granted, "what a loop is granted");
    raise_on(status, "loop");
    py::dict found = histogram_of(timing->phases[NT_LOOP_WAKE]);
    found["ticks"] = timing->ticks;
    found["missed"] = timing->missed;
    found["overrun"] = timing->overrun;
    found["refused"] = std::string(realtime.refused);
    return found;
}

void bind_timing(py::module_ &rigs)
{
    rigs.def("latency", latency);
}
