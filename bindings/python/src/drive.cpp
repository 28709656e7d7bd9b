// SPDX-License-Identifier: BSD-3-Clause
// A half driven along z without a controller, as calibration wants it: one target a period, and what was read then.
#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "descriptions.h"
#include "hal.h"
#include "nanotouch/advanced/sim.h"

// A simulated rig of which one half is driven; its clock is ticks times period.
struct Simulated {
    std::shared_ptr<nt_plan> plan = std::make_shared<nt_plan>();
    nt_sim sim{};
    Simulated(const nt_plan &of, const Described<nt_rig> &rig, double period, double clearance, uint64_t seed)
    {
        nt_plan_copy(plan.get(), &of);
        nt_sim_setup setup{};
        setup.plan = plan.get();
        setup.rig = &rig.value;
        setup.period = period;
        setup.clearance = clearance;
        setup.seed = seed;
        raise_on(nt_sim_init(&sim, &setup), "simulated rig");
    }
};

struct SimulatedHalf : Half {
    py::object kept;
    SimulatedHalf(const py::object &given, nt_half half) : kept(given)
    {
        auto &sim = given.cast<Simulated &>().sim;
        if (half == NT_HALF_MASTER)
            choice = {nt_sim_master_backend(), &sim.master};
        else
            choice = {nt_sim_slave_backend(), &sim.slave};
    }
};

// Targets are played to their end, or until what is felt reaches `turn`; then back again if it shall return.
struct Drive {
    nt_host host{};
    nt_hal hal{};
    nt_half half = NT_HALF_SLAVE;
    bool is_real = false, returns = false;
    double period = 0.0, turn = 0.0; // [s]; [m]
    std::vector<double> targets;     // from where it stands [m]; of a master its motor force [N]
    std::vector<double> measured, written, position, felt, told;
    double start[NT_AXES] = {};
    size_t next = 0;
    bool goes_back = false;
    int64_t now = 0; // of a simulated rig [ns]
    const char *stopped = "";
    std::vector<std::string> said;
};

static int64_t drive_now(const nt_host *host)
{
    const auto &d = *static_cast<const Drive *>(host->context);
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return d.is_real ? std::chrono::duration_cast<std::chrono::nanoseconds>(now).count() : d.now;
}

static void drive_say(const nt_host *host, const char *text)
{
    static_cast<Drive *>(host->context)->said.emplace_back(text ? text : "");
}

// Why it must not go on; "" if it may.
static const char *reason_of(const Drive &d)
{
    const nt_reading &reading = d.hal.reading;
    if (reading.flags & NT_SAMPLE_EMERGENCY_STOP)
        return "emergency stop";
    if (reading.flags & NT_SAMPLE_LIMIT_SWITCH)
        return "limit switch";
    if (reading.flags & NT_SAMPLE_DEVICE_LOST)
        return "device lost";
    if (reading.flags & NT_SAMPLE_INVALID || !std::isfinite(reading.position[NT_Z]))
        return "invalid reading";
    if (d.half == NT_HALF_MASTER)
        return "";
    if (reading.flags & NT_SAMPLE_SATURATED)
        return "deflection at the end of its range";
    return std::isfinite(reading.felt[NT_Z]) ? "" : "no deflection";
}

static void begin(Drive &d)
{
    for (int axis = 0; axis < NT_AXES; ++axis)
        d.start[axis] = d.half == NT_HALF_SLAVE ? d.hal.reading.position[axis] : 0.0;
    for (double &start : d.start)
        start = std::isfinite(start) ? start : 0.0;
}

// The next target; false: there is none.
static bool advance(Drive &d)
{
    if (!d.goes_back && d.half == NT_HALF_SLAVE && d.hal.reading.felt[NT_Z] >= d.turn) {
        if (!d.returns)
            return false;
        d.goes_back = true;
    }
    if (d.goes_back ? d.next == 0 : d.next == d.targets.size()) {
        if (d.goes_back || !d.returns)
            return false;
        d.goes_back = true;
    }
    d.next = d.goes_back ? d.next - 1 : d.next + 1;
    return true;
}

static int tick(void *context, uint64_t number, double)
{
    auto &d = *static_cast<Drive *>(context);
    (void)nt_hal_read(&d.hal);
    if (number == 0)
        begin(d);
    d.stopped = reason_of(d);
    if (d.stopped[0] || !advance(d))
        return 1;
    nt_action action{};
    action.size = sizeof action;
    action.tick = number;
    action.time = drive_now(&d.host);
    for (int axis = 0; axis < NT_AXES; ++axis)
        action.target[axis] = d.start[axis];
    action.target[NT_Z] += d.targets[d.goes_back ? d.next : d.next - 1];
    d.measured.push_back(1e-9 * static_cast<double>(d.hal.reading.time));
    d.written.push_back(1e-9 * static_cast<double>(action.time));
    d.position.push_back(d.hal.reading.position[NT_Z]);
    d.felt.push_back(d.hal.reading.felt[NT_Z]);
    d.told.push_back(action.target[NT_Z]);
    (void)nt_hal_write(&d.hal, &action);
    d.now += std::llround(1e9 * d.period);
    return 0;
}

static nt_status run(Drive &d, Half &half, nt_problem &problem)
{
    d.host = {sizeof d.host, NT_HAL_API_VERSION, drive_now, drive_say, &d};
    nt_status status = nt_hal_open(&d.hal, d.half, &half.choice, &d.host, &problem);
    const nt_configuration configuration = {sizeof configuration, 0, d.period, 1e-6, half.option.c_str()};
    if (status == NT_OK)
        status = nt_hal_configure(&d.hal, &configuration, &problem);
    if (status == NT_OK)
        status = nt_hal_arm(&d.hal);
    const uint64_t most = 2 * d.targets.size() + 2;
    if (status == NT_OK && d.is_real)
        status = nt_loop_run(d.period, most, tick, &d, nullptr);
    for (uint64_t i = 0; status == NT_OK && !d.is_real && i < most; ++i)
        if (tick(&d, i, 0.0))
            break;
    nt_hal_close(&d.hal);
    return status;
}

static py::dict drive(const py::object &given, bool is_master, double period, std::vector<double> targets, double turn,
                      bool returns)
{
    Drive d;
    d.half = is_master ? NT_HALF_MASTER : NT_HALF_SLAVE;
    d.is_real = !py::isinstance<Simulated>(given);
    d.returns = returns;
    d.period = period;
    d.turn = turn;
    const size_t most = 2 * targets.size() + 2;
    d.targets = std::move(targets);
    for (auto *column : {&d.measured, &d.written, &d.position, &d.felt, &d.told})
        column->reserve(most); // the loop takes no memory
    const std::shared_ptr<Half> half =
        d.is_real ? half_of(given, d.half) : std::make_shared<SimulatedHalf>(given, d.half);
    nt_problem problem{};
    nt_status status;
    {
        const py::gil_scoped_release release;
        status = run(d, *half, problem);
    }
    half->rethrow();
    raise_on(status, problem, d.said.empty() ? "calibration" : d.said.back());
    py::dict found;
    found["measured"] = d.measured;
    found["written"] = d.written;
    found["position"] = d.position;
    found["felt"] = d.felt;
    found["told"] = d.told;
    found["stopped"] = std::string(d.stopped);
    return found;
}

void bind_drive(py::module_ &module)
{
    py::class_<Simulated>(module, "Simulated")
        .def(py::init<const nt_plan &, const Described<nt_rig> &, double, double, uint64_t>());
    module.def("drive", drive);
}
