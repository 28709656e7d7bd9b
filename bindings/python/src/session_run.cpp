// SPDX-License-Identifier: BSD-3-Clause
// session.h: a session running, and what comes out of it: records, events, frames, snapshots
#include "frames.h"
#include "session.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

// A column of numbers: where it lies in a record, and for vectors along which axis.
struct Column {
    const char *name;
    size_t offset;
};
#define SCALAR(name) {#name, offsetof(nt_record, name)}
#define ALONG(name, member, axis) {name, offsetof(nt_record, member) + (axis) * sizeof(double)}
static constexpr Column columns[] = {
    SCALAR(time),
    ALONG("x", stage_position, NT_X),
    ALONG("y", stage_position, NT_Y),
    ALONG("master_position", master_position, NT_Z),
    ALONG("operator_force", operator_force, NT_Z),
    ALONG("stage_position", stage_position, NT_Z),
    ALONG("stage_command", stage_command, NT_Z),
    ALONG("deflection", deflection, NT_Z),
    SCALAR(slave_force),
    ALONG("motor_force", motor_force, NT_Z),
    SCALAR(gap),
    ALONG("tip_force", tip_force, NT_Z),
    SCALAR(contact_radius),
    SCALAR(surface_height),
    SCALAR(age),
    SCALAR(master_age),
    SCALAR(lateness),
};
// Where the master has more than one axis.
static constexpr Column sideways[] = {
    ALONG("master_x", master_position, NT_X),        ALONG("master_y", master_position, NT_Y),
    ALONG("operator_force_x", operator_force, NT_X), ALONG("operator_force_y", operator_force, NT_Y),
    ALONG("motor_force_x", motor_force, NT_X),       ALONG("motor_force_y", motor_force, NT_Y),
};
// And there, or where the lever gives way sideways.
static constexpr Column lateral[] = {
    ALONG("tip_force_x", tip_force, NT_X),
    ALONG("tip_force_y", tip_force, NT_Y),
};
// Where it does.
static constexpr Column deflections[] = {
    ALONG("deflection_x", deflection, NT_X),
    ALONG("deflection_y", deflection, NT_Y),
};
// Where the lever taps.
static constexpr Column tapping[] = {
    SCALAR(amplitude),
    SCALAR(lag),
};

static py::array_t<double> column_of(const Records &records, const Shape &shape, const Column &column)
{
    py::array_t<double> values(shape);
    double *out = values.mutable_data();
    for (py::ssize_t i = 0; i < values.size(); ++i)
        std::memcpy(&out[i], reinterpret_cast<const char *>(&records[static_cast<size_t>(i)]) + column.offset,
                    sizeof(double));
    return values;
}

template <class T>
static py::array_t<T> bits_of(const Records &records, const Shape &shape, uint32_t nt_record::*member)
{
    py::array_t<T> values(shape);
    T *out = values.mutable_data();
    for (py::ssize_t i = 0; i < values.size(); ++i)
        out[i] = static_cast<T>(records[static_cast<size_t>(i)].*member);
    return values;
}

py::dict columns_of(const Session &self, const Records &records, const Shape &shape)
{
    py::dict out;
    const auto add = [&](const Column &column) { out[column.name] = column_of(records, shape, column); };
    std::for_each(std::begin(columns), std::end(columns), add);
    const nt_touch *touch = nt_session_touch(self.handle);
    const bool gives_way = touch->rig.probe.lateral_stiffness > 0.0;
    if (touch->leads_sideways)
        std::for_each(std::begin(sideways), std::end(sideways), add);
    if (touch->leads_sideways || gives_way)
        std::for_each(std::begin(lateral), std::end(lateral), add);
    if (gives_way)
        std::for_each(std::begin(deflections), std::end(deflections), add);
    if (touch->mode == NT_MODE_TAPPING)
        std::for_each(std::begin(tapping), std::end(tapping), add);
    out["state"] = bits_of<uint8_t>(records, shape, &nt_record::state);
    out["reasons"] = bits_of<uint32_t>(records, shape, &nt_record::reasons);
    out["flags"] = bits_of<uint32_t>(records, shape, &nt_record::flags);
    out["phase"] = bits_of<uint8_t>(records, shape, &nt_record::phase);
    return out;
}

static py::dict read_records(Session &self, long count)
{
    if (count < 0)
        raise(NT_E_RANGE, "read: rows = " + std::to_string(count) + ": valid is 0 or more");
    count = std::min(count, 2 * nt_session_setup_of(self.handle)->ring_capacity + 2); // more cannot wait
    Records records(static_cast<size_t>(count));
    const long got = alone(self, [&](nt_session *handle) { return nt_session_read(handle, records.data(), count); });
    return columns_of(self, records, {got});
}

static std::string field_of(const nt_event &event)
{
    int count = 0;
    const nt_field *fields = event.kind == NT_EVENT_SCENE ? nt_scene_fields(&count) : nt_settings_fields(&count);
    return event.field < static_cast<uint32_t>(count) ? fields[event.field].name : "";
}

// An event as a recording keeps it: [tick, name, numbers].
static py::tuple tuple_of(const nt_event &event)
{
    const double *n = event.value;
    const auto as = [&](const char *name, const py::list &numbers) {
        return py::make_tuple(event.tick, name, numbers);
    };
    py::list numbers;
    const auto take = [&](int count) {
        for (int i = 0; i < count; ++i)
            numbers.append(n[i]);
        return numbers;
    };
    switch (static_cast<nt_event_kind>(event.kind)) {
    case NT_EVENT_AIM:
        return as("aim", take(3));
    case NT_EVENT_RESCALE:
        return as("rescale", take(2));
    case NT_EVENT_MODE:
        numbers.append(mode_name(static_cast<nt_mode>(n[0])));
        return as("mode", numbers);
    case NT_EVENT_ARM:
    case NT_EVENT_CLUTCH:
    case NT_EVENT_STOP:
        numbers.append(n[0] != 0.0);
        return as(event.kind == NT_EVENT_ARM ? "arm" : event.kind == NT_EVENT_CLUTCH ? "clutch" : "stop", numbers);
    case NT_EVENT_SETTING:
    case NT_EVENT_SCENE:
        numbers.append(field_of(event));
        numbers.append(n[0]);
        return as(event.kind == NT_EVENT_SCENE ? "scene" : "setting", numbers);
    case NT_EVENT_REWIND:
        return as("rewind", take(2));
    case NT_EVENT_INDEX:
        return as("index", take(1));
    case NT_EVENT_DENT:
        return as(event.field == 0 ? "dent" : "dent_size", take(4));
    case NT_EVENT_UNDENT:
        return as("undent", numbers);
    case NT_EVENT_LAY_ROD:
        return as("lay_rod", take(3));
    case NT_EVENT_TURNED:
        return as("turned", take(2));
    case NT_EVENT_LAY:
    case NT_EVENT_PUSHED:
        numbers.append(event.field);
        return as(event.kind == NT_EVENT_LAY ? "lay" : "pushed", take(event.kind == NT_EVENT_LAY ? 2 : 4));
    case NT_EVENT_KINDS:
        break;
    }
    return as("unknown", numbers);
}

static py::list read_events(Session &self)
{
    py::list out;
    nt_event event;
    const auto next = [&] { return alone(self, [&](nt_session *h) { return nt_session_read_events(h, &event, 1); }); };
    while (next() == 1)
        out.append(tuple_of(event));
    return out;
}

static void advance_session(Session &self, long ticks)
{
    const nt_status status = alone(self, [ticks](nt_session *handle) { return nt_session_advance(handle, ticks); });
    self.rethrow();
    if (status == NT_E_CAPACITY)
        raise(status, "advance: the ring of records is full: read them first");
    if (status == NT_E_STATE)
        raise(status, "advance: the session runs in its thread (halt it first), or this process was forked off the one "
                      "that shows it");
    raise_on(status, "advance");
}

// Short: the GIL stays, unless another thread is in the session, whose half in Python may wait for it.
static nt_frame step_session(Session &self, const nt_input *input)
{
    nt_frame frame;
    refuse_inside(self);
    std::unique_lock<std::mutex> lock(self.one_at_a_time, std::try_to_lock);
    if (!lock) {
        const py::gil_scoped_release release;
        lock.lock();
    }
    nt_problem problem{};
    if (input)
        raise_on(nt_session_check_input(self.handle, input, &problem), problem, "operator input");
    const nt_status status = nt_session_step(self.handle, input, &frame);
    self.rethrow();
    if (status == NT_E_CAPACITY)
        raise(status, "step: records or inputs wait to be read: call read() now and then, or open the session with "
                      "recorded=False");
    raise_on(status, "step");
    return frame;
}

static void start(Session &self, int pace, uint64_t ticks)
{
    const nt_status status =
        alone(self, [=](nt_session *handle) { return nt_session_start(handle, static_cast<nt_pace>(pace), ticks); });
    const uint32_t can = nt_session_capabilities(self.handle, NT_HALF_MASTER)->can |
                         nt_session_capabilities(self.handle, NT_HALF_SLAVE)->can;
    if (status == NT_E_UNSUPPORTED && pace == NT_PACE_HARD && can & NT_IS_SLOW)
        raise(status, "start: pace 'hard': a half that is written in Python runs at 'free' and 'wall' only");
    if (status == NT_E_UNSUPPORTED && nt_session_pace(self.handle) == NT_PACE_HARD)
        raise(status, "start: a real slave, whether it leads the clock or not, runs at pace 'hard' only");
    if (status == NT_E_UNSUPPORTED)
        raise(status, "start: a real master on a simulated slave runs at pace 'wall', or 'hard'");
    if (status == NT_E_RANGE) {
        const nt_wall_pace wall = nt_session_wall_pace(self.handle);
        const nt_problem problem = problem_of(wall.margin.field, "", wall.margin.margin,
                                              nt_session_setup_of(self.handle)->minimum_margin, INFINITY);
        char late[96];
        std::snprintf(late, sizeof late, "start: a force waits %.3g ms at pace 'wall' on this machine",
                      1e3 * (wall.hold + wall.latency));
        raise_on(status, problem, late);
    }
    raise_on(status, "start");
}

static void halt(Session &self)
{
    const nt_status status = alone(self, [](nt_session *handle) { return nt_session_halt(handle); });
    self.rethrow();
    raise_on(status, "halt");
}

static py::dict progress_of(const Session &self)
{
    const nt_progress found = nt_session_progress(self.handle);
    py::dict out;
    out["ticks"] = found.ticks;
    out["dropped"] = found.dropped;
    out["slowdown"] = found.slowdown;
    out["worst_delay"] = found.worst_delay;
    out["runs"] = found.runs != 0;
    out["paused"] = found.paused != 0;
    out["stands"] = found.stands != 0;
    out["status"] = nt_status_message(found.status);
    return out;
}

// A snapshot keeps its session alive.
struct Snapshot {
    nt_snapshot *handle = nullptr;
    ~Snapshot()
    {
        nt_snapshot_close(handle);
    }
};

static std::unique_ptr<Snapshot> snapshot(Session &self)
{
    auto made = std::make_unique<Snapshot>();
    raise_on(alone(self, [&](nt_session *handle) { return nt_session_snapshot(handle, &made->handle); }), "snapshot");
    return made;
}

static py::tuple vector(const double (&values)[3])
{
    return py::make_tuple(values[0], values[1], values[2]);
}

static void bind_frame(py::module_ &module)
{
    py::class_<nt_frame>(module, "Frame")
        .def_readonly("sequence", &nt_frame::sequence)
        .def_readonly("time", &nt_frame::time)
        .def_property_readonly("tip_position", [](const nt_frame &self) { return vector(self.tip_position); })
        .def_property_readonly("tip_force", [](const nt_frame &self) { return vector(self.tip_force); })
        .def_property_readonly("master_position", [](const nt_frame &self) { return vector(self.master_position); })
        .def_property_readonly("motor_force", [](const nt_frame &self) { return vector(self.motor_force); })
        .def_readonly("base_height", &nt_frame::base_height)
        .def_readonly("deflection", &nt_frame::deflection)
        .def_readonly("gap", &nt_frame::gap)
        .def_readonly("contact_radius", &nt_frame::contact_radius)
        .def_readonly("state", &nt_frame::state)
        .def_readonly("reasons", &nt_frame::reasons)
        .def_readonly("phase", &nt_frame::phase)
        .def_readonly("changes", &nt_frame::changes);
}

static void bind_thread(py::class_<Session> &type)
{
    type.def("start", &start, py::arg("pace"), py::arg("ticks"))
        .def("halt", &halt)
        .def("pause", [](Session &self, bool paused) { raise_on(nt_session_pause(self.handle, paused), "pause"); })
        .def("step_on", [](Session &self, long ticks) { raise_on(nt_session_step_on(self.handle, ticks), "step"); })
        .def("set_speed",
             [](Session &self, double speed) {
                 nt_problem problem{};
                 raise_on(nt_session_set_speed(self.handle, speed, &problem), problem, "speed");
             })
        .def_property_readonly("progress", &progress_of);
}

// What a half says of itself.
static py::dict described_half(const Session &self, int half)
{
    const nt_capabilities *found = nt_session_capabilities(self.handle, static_cast<nt_half>(half));
    const auto can = [found](uint32_t bit) { return (found->can & bit) != 0; };
    py::list channels;
    for (int i = 0; i < found->rows; ++i) {
        const nt_channel_row &row = found->channels[i];
        channels.append(py::make_tuple(row.name, row.unit, row.driven != 0, row.axis, row.minimum, row.maximum,
                                       row.step, row.noise, row.latency, row.safe));
    }
    return py::dict(py::arg("axes") = found->axes, py::arg("period") = found->period,
                    py::arg("feels") = can(NT_CAN_FEEL), py::arg("pushes") = can(NT_CAN_PUSH),
                    py::arg("servos") = can(NT_CAN_SERVO), py::arg("leads") = can(NT_LEADS_CLOCK),
                    py::arg("real") = can(NT_IS_REAL), py::arg("event_driven") = can(NT_IS_EVENT_DRIVEN),
                    py::arg("slow") = can(NT_IS_SLOW), py::arg("taps") = can(NT_CAN_TAP),
                    py::arg("channels") = channels);
}

// How it runs and why it stands still.
static void bind_state(py::class_<Session> &type)
{
    type.def_property_readonly("pace",
                               [](const Session &self) { return static_cast<int>(nt_session_pace(self.handle)); })
        .def_property_readonly("wall_pace",
                               [](const Session &self) {
                                   const nt_wall_pace wall = nt_session_wall_pace(self.handle);
                                   return py::make_tuple(wall.hold, wall.latency, wall.margin.margin);
                               })
        .def_property_readonly("since", [](const Session &self) { return nt_session_touch_state(self.handle)->since; })
        .def_property_readonly("reasons",
                               [](const Session &self) { return nt_session_touch_state(self.handle)->command.reasons; })
        .def_property_readonly(
            "state",
            [](const Session &self) { return static_cast<int>(nt_session_touch_state(self.handle)->supervisor.state); })
        .def_property_readonly(
            "phase", [](const Session &self) { return static_cast<int>(nt_session_touch_state(self.handle)->phase); });
}

void bind_session_run(py::module_ &module, py::class_<Session> &type)
{
    bind_frame(module);
    py::class_<Snapshot>(module, "Snapshot");
    bind_thread(type);
    bind_session_left(type);
    type.def("advance", &advance_session)
        .def("step", &step_session, py::arg("input").none(true))
        .def("read", &read_records)
        .def("read_events", &read_events)
        .def("half", &described_half)
        .def("publish",
             [](Session &self, const std::string &name) {
                 const char *given = name.empty() ? nullptr : name.c_str();
                 const nt_status status = alone(self, [=](nt_session *h) { return nt_session_publish(h, given); });
                 if (status == NT_E_STATE)
                     raise(status, "publish: another session has the name '" + name +
                                       "', or this one runs or is published already");
                 raise_on(status, "publish");
             })
        .def("describe",
             [](Session &self, const std::string &text) {
                 nt_frames *frames = nt_session_frames(self.handle);
                 if (frames)
                     raise_on(nt_frames_describe(frames, text.c_str()), "description");
             })
        .def("snapshot", &snapshot, py::keep_alive<0, 1>())
        .def("rewind",
             [](Session &self, double duration) {
                 nt_problem problem{};
                 const nt_status status =
                     alone(self, [&](nt_session *h) { return nt_session_rewind(h, duration, &problem); });
                 if (status == NT_E_UNSUPPORTED && !nt_session_progress(self.handle).runs)
                     raise(NT_E_STATE, "rewind: the session does not run; reset and restore take it back");
                 if (status == NT_E_NO_SOLUTION)
                     raise(status, "rewind: " + std::to_string(duration) +
                                       " s ago is not kept: valid is half a minute at most, since the run was started "
                                       "and since the last change");
                 raise_on(status, problem, "rewind");
             })
        .def("restore", [](Session &self, const Snapshot &kept) {
            nt_problem problem{};
            const nt_status status =
                alone(self, [&](nt_session *h) { return nt_session_restore(h, kept.handle, &problem); });
            raise_on(status, problem, "restore: the snapshot was taken with another setup");
        });
    bind_state(type);
}
