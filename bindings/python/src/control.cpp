// SPDX-License-Identifier: BSD-3-Clause
// control.h, touch.h: a law written in Python, the supervisor on plain numbers, and the touch step run again on a
// recording
#include "control.h"
#include "internal/control.h"
#include "words.h"

static nt_effort effort_of(const py::object &answer)
{
    try {
        const auto [force, stage] = answer.cast<std::pair<double, double>>();
        return {force, stage};
    } catch (const py::cast_error &) {
        throw py::type_error("control: the law must return motor force [N] and stage position [m], two numbers, not " +
                             py::repr(answer).cast<std::string>());
    }
}

static nt_effort call_law(void *context, const nt_gains *gains, const nt_signals *signals)
{
    auto *law = static_cast<OwnLaw *>(context);
    const py::gil_scoped_acquire gil;
    (void)gains;
    try {
        return effort_of(law->call(*signals));
    } catch (...) {
        if (!law->error)
            law->error = std::current_exception();
        return {NAN, NAN};
    }
}

void set_control(nt_settings &settings, const std::string &name)
{
    const int choice = number_of(NT_CONTROL_WORDS, name);
    if (choice < 0 || choice == NT_CONTROL_OWN)
        throw py::value_error(name);
    settings.control = {static_cast<nt_control_choice>(choice), nullptr, nullptr};
}

void set_control(nt_settings &settings, OwnLaw &law)
{
    settings.control = {NT_CONTROL_OWN, call_law, &law};
}

nt_mode mode_of(const std::string &name)
{
    const int mode = number_of(NT_MODE_WORDS, name);
    if (mode < 0)
        throw py::value_error(name);
    return static_cast<nt_mode>(mode);
}

std::string mode_name(nt_mode mode)
{
    return word_of(NT_MODE_WORDS, mode);
}

struct Supervisor {
    nt_supervisor supervisor;
    nt_supervisor_state state;
};

static py::tuple supervise(Supervisor &self, const nt_sample &sample, const nt_situation &situation)
{
    const nt_state state = nt_supervisor_step(&self.supervisor, &self.state, &sample, &situation);
    return py::make_tuple(static_cast<int>(state), self.state.reasons);
}

static nt_sample sample_of(const py::dict &numbers)
{
    nt_sample sample{};
    sample.age = sample.master_age = numbers["age"].cast<double>();
    sample.lateness = numbers["lateness"].cast<double>();
    sample.master_position[NT_Z] = numbers["master_position"].cast<double>();
    sample.operator_force[NT_Z] = numbers["operator_force"].cast<double>();
    sample.stage_position[NT_Z] = numbers["stage_position"].cast<double>();
    sample.deflection[NT_Z] = numbers["deflection"].cast<double>();
    sample.flags = numbers["flags"].cast<uint32_t>();
    return sample;
}

// What was measured, one array per number, and what comes out of it. Of a master of one axis nothing lies sideways.
struct Measured {
    Array age, master_age, lateness, master_position, operator_force, stage_position, deflection, x, y;
    py::array_t<uint32_t> flags;
    Array master_x, master_y;
    bool leads_sideways;
    Array amplitude, lag;
    bool taps;
};

static nt_sample sample_at(const Measured &measured, py::ssize_t i)
{
    nt_sample sample{};
    sample.tick = static_cast<uint64_t>(i);
    sample.age = measured.age.data()[i];
    sample.master_age = measured.master_age.data()[i];
    sample.lateness = measured.lateness.data()[i];
    sample.master_position[NT_Z] = measured.master_position.data()[i];
    sample.operator_force[NT_Z] = measured.operator_force.data()[i];
    sample.stage_position[NT_Z] = measured.stage_position.data()[i];
    sample.deflection[NT_Z] = measured.deflection.data()[i];
    sample.stage_position[NT_X] = measured.x.data()[i];
    sample.stage_position[NT_Y] = measured.y.data()[i];
    if (measured.leads_sideways) {
        sample.master_position[NT_X] = measured.master_x.data()[i];
        sample.master_position[NT_Y] = measured.master_y.data()[i];
    }
    if (measured.taps) {
        sample.amplitude = measured.amplitude.data()[i];
        sample.lag = measured.lag.data()[i];
    }
    sample.flags = measured.flags.data()[i];
    return sample;
}

static Measured measured_of(const py::dict &columns)
{
    const auto column = [&](const char *name) { return columns[name].cast<Array>(); };
    const bool leads_sideways = columns.contains("master_x"), taps = columns.contains("amplitude");
    return {column("age"),
            column(columns.contains("master_age") ? "master_age" : "age"), // one age stood for both once
            column("lateness"),
            column("master_position"),
            column("operator_force"),
            column("stage_position"),
            column("deflection"),
            column("x"),
            column("y"),
            columns["flags"].cast<py::array_t<uint32_t>>(),
            leads_sideways ? column("master_x") : Array(),
            leads_sideways ? column("master_y") : Array(),
            leads_sideways,
            taps ? column("amplitude") : Array(),
            taps ? column("lag") : Array(),
            taps};
}

// The touch step as a recording has run it: its settings may have changed on the way.
struct Replay {
    nt_rig rig;
    nt_settings settings;
    nt_mode mode;
    std::vector<double> size; // of the surface, which the tip does not leave [m]; empty: it has no ends
    nt_touch touch;
    nt_touch_state state;

    void make()
    {
        nt_problem problem{};
        raise_on(nt_touch_make(&touch, &rig, &settings, mode, &problem), problem, "replay");
        for (size_t i = 0; i < size.size(); ++i) {
            touch.borders[i][0] = 0.0;
            touch.borders[i][1] = size[i];
        }
    }
};

static nt_status change_setting(Replay &replay, const std::string &name, double value)
{
    int count = 0;
    const nt_field *fields = nt_settings_fields(&count);
    for (int i = 0; i < count; ++i)
        if (name == fields[i].name) {
            nt_field_set(&fields[i], &replay.settings, value);
            replay.make();
            return NT_OK;
        }
    return NT_E_ARGUMENT;
}

// A request between two ticks: its name and up to three numbers. A change of the scene, a dent, or a stop, shows in
// what was measured.
static nt_status request(Replay &replay, const std::string &name, const py::list &n)
{
    const auto number = [&](size_t i) { return n[i].cast<double>(); };
    nt_touch_state &state = replay.state;
    if (name == "aim")
        return nt_touch_aim(&replay.touch, &state, number(0), number(1), number(2));
    if (name == "arm")
        return nt_touch_arm(&state, n[0].cast<bool>());
    if (name == "mode")
        return nt_touch_set_mode(&state, mode_of(n[0].cast<std::string>()));
    if (name == "setting")
        return change_setting(replay, n[0].cast<std::string>(), number(1));
    if (name == "clutch") {
        nt_touch_clutch(&state, n[0].cast<bool>());
        return NT_OK;
    }
    if (name == "scene" || name == "stop" || name == "dent" || name == "dent_size" || name == "undent" ||
        name == "lay" || name == "lay_rod" || name == "pushed" || name == "turned")
        return NT_OK;
    if (name == "index") {
        nt_touch_index(&state, number(0));
        return NT_OK;
    }
    const nt_scaling scaling = {number(0), number(1)};
    if (name == "rescale") { // a change of settings that comes later is made with these scales
        replay.settings.gains.alpha_p = scaling.alpha_p;
        replay.settings.gains.alpha_f = scaling.alpha_f;
    }
    return name == "rescale" ? nt_touch_rescale(&state, &scaling) : NT_E_ARGUMENT;
}

// Those of this tick, in the order in which they were done.
static void replay_requests(Replay &replay, const py::list &events, py::ssize_t tick)
{
    for (const py::handle item : events) {
        const auto event = item.cast<py::tuple>();
        const auto name = event[1].cast<std::string>();
        if (event[0].cast<py::ssize_t>() == tick)
            raise_on(request(replay, name, event[2].cast<py::list>()), "replay: " + name);
    }
}

static py::dict replay(const Described<nt_rig> &rig, const Described<nt_settings> &settings, const py::object &control,
                       const py::dict &start, const py::dict &columns)
{
    Replay run{rig.value,
               settings.value,
               mode_of(start["mode"].cast<std::string>()),
               start["size"].cast<std::vector<double>>(),
               {},
               {}};
    OwnLaw law{control, nullptr};
    if (py::isinstance<py::str>(control))
        set_control(run.settings, control.cast<std::string>());
    else
        set_control(run.settings, law);
    run.make();
    run.state = nt_touch_start(&run.touch, start["master"].cast<double>(), start["x"].cast<double>(),
                               start["y"].cast<double>());
    const auto events = start["events"].cast<py::list>();
    std::set<py::ssize_t> eventful;
    for (const py::handle event : events)
        eventful.insert(event.cast<py::tuple>()[0].cast<py::ssize_t>());
    const Measured measured = measured_of(columns);
    const py::ssize_t count = measured.deflection.size();
    py::array_t<double> motor_force(count), stage_command(count);
    py::array_t<uint8_t> states(count);
    py::array_t<uint32_t> reasons(count);
    for (py::ssize_t i = 0; i < count; ++i) {
        if (eventful.count(i) != 0)
            replay_requests(run, events, i);
        const nt_sample sample = sample_at(measured, i);
        nt_command command;
        nt_touch_step(&run.touch, &run.state, &sample, &command);
        motor_force.mutable_data()[i] = command.motor_force[NT_Z];
        stage_command.mutable_data()[i] = command.stage_position[NT_Z];
        states.mutable_data()[i] = static_cast<uint8_t>(command.state);
        reasons.mutable_data()[i] = command.reasons;
    }
    law.rethrow();
    py::dict out;
    out["motor_force"] = motor_force;
    out["stage_command"] = stage_command;
    out["state"] = states;
    out["reasons"] = reasons;
    return out;
}

static void bind_signals(py::module_ &module)
{
    py::class_<nt_signals>(module, "Signals")
        .def_readonly("period", &nt_signals::period)
        .def_readonly("master_position", &nt_signals::master_position)
        .def_readonly("master_speed", &nt_signals::master_speed)
        .def_readonly("smooth_speed", &nt_signals::smooth_speed)
        .def_readonly("operator_force", &nt_signals::operator_force)
        .def_readonly("smooth_force", &nt_signals::smooth_force)
        .def_readonly("slave_force", &nt_signals::slave_force)
        .def_readonly("felt_force", &nt_signals::felt_force)
        .def_readonly("stage_position", &nt_signals::stage_position)
        .def_readonly("stage_speed", &nt_signals::stage_speed)
        .def_readonly("target", &nt_signals::target)
        .def_readonly("master_damping", &nt_signals::master_damping)
        .def_readonly("gain_factor", &nt_signals::gain_factor)
        .def_property_readonly("alpha_p", [](const nt_signals &self) { return self.scaling.alpha_p; })
        .def_property_readonly("alpha_f", [](const nt_signals &self) { return self.scaling.alpha_f; });
}

void bind_control(py::module_ &module)
{
    bind_signals(module);
    py::class_<Supervisor>(module, "Supervisor")
        .def(py::init([](const Described<nt_rig> &rig, const Described<nt_settings> &settings) {
            return Supervisor{nt_supervisor_make(&rig.value, &settings.value), nt_supervisor_start()};
        }))
        .def("step",
             [](Supervisor &self, const py::dict &numbers, double reference, bool moves_sideways, bool unstable) {
                 return supervise(self, sample_of(numbers), {reference, moves_sideways, unstable});
             })
        .def("arm",
             [](Supervisor &self, bool confirmed) { raise_on(nt_supervisor_arm(&self.state, confirmed), "arm"); });
    module.def("replay", &replay);
    module.def("set_control",
               [](Described<nt_settings> &settings, const std::string &name) { set_control(settings.value, name); });
    py::list reasons;
    for (uint32_t bit = 1; nt_reason_name(bit)[0] != 0; bit <<= 1)
        reasons.append(nt_reason_name(bit));
    module.attr("reasons") = py::tuple(reasons);
}
