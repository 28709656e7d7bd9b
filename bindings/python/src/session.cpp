// SPDX-License-Identifier: BSD-3-Clause
// session.h
#include <memory>
#include <mutex>
#include <vector>

#include "control.h"
#include "faults.h"
#include "surface.h"

struct Session {
    nt_session *handle = nullptr;
    Terrain terrain; // outlives the handle, as the law does
    OwnLaw law;
    std::unique_ptr<Described<nt_settings>> amounts; // what the law amounts to, where that is known
    std::mutex one_at_a_time;
    ~Session()
    {
        nt_session_close(handle);
    }
};

struct Column {
    const char *name;
    double nt_record::*member;
};
static constexpr Column columns[] = {
    {"time", &nt_record::time},
    {"x", &nt_record::x},
    {"y", &nt_record::y},
    {"master_position", &nt_record::master_position},
    {"operator_force", &nt_record::operator_force},
    {"stage_position", &nt_record::stage_position},
    {"stage_command", &nt_record::stage_command},
    {"deflection", &nt_record::deflection},
    {"slave_force", &nt_record::slave_force},
    {"motor_force", &nt_record::motor_force},
    {"gap", &nt_record::gap},
    {"tip_force", &nt_record::tip_force},
    {"contact_radius", &nt_record::contact_radius},
    {"surface_height", &nt_record::surface_height},
    {"age", &nt_record::age},
    {"lateness", &nt_record::lateness},
};

static std::unique_ptr<Session> open_session(const Described<nt_scene> &scene, const Described<nt_rig> &rig,
                                             const Described<nt_settings> &settings, const Terrain *terrain,
                                             py::dict options)
{
    nt_session_setup setup = nt_session_defaults();
    setup.scene = scene.value;
    setup.rig = rig.value;
    setup.settings = settings.value;
    setup.mode = mode_of(options["mode"].cast<std::string>());
    auto made = std::make_unique<Session>();
    if (terrain) {
        made->terrain = *terrain;
        setup.surface = nt_terrain_surface(terrain->made.get());
        setup.radii = nt_terrain_radii(terrain->made.get());
        setup.bank = nt_terrain_bank(terrain->made.get());
    }
    setup.x = options["x"].cast<double>();
    setup.y = options["y"].cast<double>();
    setup.clearance = options["clearance"].cast<double>();
    setup.rise = options["rise"].cast<double>();
    setup.slope = options["slope"].cast<double>();
    setup.preflight = options["preflight"].cast<bool>();
    setup.probe_model = static_cast<nt_probe_model>(options["probe_model"].cast<int>());
    setup.substep = options["substep"].cast<double>();
    const nt_faults faults = faults_of(options["faults"]);
    setup.faults = &faults;
    setup.seed = options["seed"].cast<uint64_t>();
    setup.minimum_margin = options["minimum_margin"].cast<double>();
    setup.demand.relative_accuracy = options["relative_accuracy"].cast<double>();
    if (!options["law"].is_none()) {
        made->law.call = options["law"];
        set_control(setup.settings, made->law);
    }
    nt_problem problem{};
    const nt_status status = nt_session_open(&made->handle, &setup, &problem);
    made->law.rethrow(); // it has been tried
    raise_on(status, problem, "session");
    if (setup.settings.control.choice == NT_CONTROL_OWN && setup.minimum_margin > 0.0) {
        Described<nt_settings> amounts{};
        const double stiffness = nt_session_plan(made->handle)->maximum_stiffness;
        if (nt_margins_own_law(&setup.rig, &setup.settings, stiffness, &amounts.value) == NT_OK)
            made->amounts = std::make_unique<Described<nt_settings>>(amounts);
        made->law.rethrow();
    }
    return made;
}

// Python threads may share a session: one call at a time, waiting without the GIL.
template <class Call> static auto alone(Session &self, Call call)
{
    py::gil_scoped_release release;
    const std::lock_guard<std::mutex> lock(self.one_at_a_time);
    return call(self.handle);
}

static void advance_session(Session &self, long ticks)
{
    const nt_status status = alone(self, [ticks](nt_session *handle) { return nt_session_advance(handle, ticks); });
    self.law.rethrow();
    raise_on(status, "advance");
}

static py::dict read_records(Session &self, long count)
{
    std::vector<nt_record> records(static_cast<size_t>(count));
    const long got = alone(self, [&](nt_session *handle) { return nt_session_read(handle, records.data(), count); });
    py::dict out;
    for (const Column &column : columns) {
        py::array_t<double> values(got);
        for (long i = 0; i < got; ++i)
            values.mutable_data()[i] = records[static_cast<size_t>(i)].*column.member;
        out[column.name] = values;
    }
    py::array_t<uint8_t> state(got), phase(got);
    py::array_t<uint32_t> reasons(got), flags(got);
    for (long i = 0; i < got; ++i) {
        const nt_record &record = records[static_cast<size_t>(i)];
        state.mutable_data()[i] = static_cast<uint8_t>(record.state);
        phase.mutable_data()[i] = static_cast<uint8_t>(record.phase);
        reasons.mutable_data()[i] = record.reasons;
        flags.mutable_data()[i] = record.flags;
    }
    out["state"] = state;
    out["reasons"] = reasons;
    out["flags"] = flags;
    out["phase"] = phase;
    return out;
}

static py::dict guarantee_of(const Session &self)
{
    const nt_guarantee guarantee = nt_session_guarantee(self.handle);
    py::dict out;
    out["reaction_time"] = guarantee.reaction_time;
    out["motion"] = guarantee.motion;
    out["ringing"] = guarantee.ringing;
    out["snap_in"] = guarantee.snap_in;
    out["noise"] = guarantee.noise;
    out["force"] = guarantee.force;
    out["with_faults"] = guarantee.with_faults;
    out["indentation"] = guarantee.indentation;
    return out;
}

static void bind_requests(py::class_<Session> &type)
{
    type.def("set_mode",
             [](Session &self, const std::string &name) {
                 const nt_mode mode = mode_of(name);
                 const nt_status status = alone(self, [=](nt_session *h) { return nt_session_set_mode(h, mode); });
                 self.law.rethrow(); // it has been tried
                 raise_on(status, "mode");
             })
        .def("rescale",
             [](Session &self, double alpha_p, double alpha_f) {
                 const nt_scaling scaling = {alpha_p, alpha_f};
                 const nt_status status = alone(self, [&](nt_session *h) { return nt_session_rescale(h, &scaling); });
                 self.law.rethrow();
                 raise_on(status, "rescale");
             })
        .def("clutch", [](Session &self,
                          bool open) { alone(self, [=](nt_session *handle) { nt_session_clutch(handle, open); }); })
        .def_property_readonly("guarantee", &guarantee_of)
        .def_property_readonly(
            "amounts",
            [](const Session &self) -> py::object { return self.amounts ? py::cast(*self.amounts) : py::none(); })
        .def_property_readonly("tare",
                               [](const Session &self) {
                                   const nt_tare tare = nt_session_tare(self.handle);
                                   return py::make_tuple(tare.deflection, tare.operator_force);
                               })
        .def_property_readonly("ticks", [](const Session &self) { return nt_session_touch_state(self.handle)->ticks; })
        .def_property_readonly(
            "phase", [](const Session &self) { return static_cast<int>(nt_session_touch_state(self.handle)->phase); });
}

void bind_session(py::module_ &module)
{
    py::class_<Session> type(module, "Session");
    bind_requests(type);
    type.def(py::init(&open_session), py::arg("scene"), py::arg("rig"), py::arg("settings"), py::arg("terrain"),
             py::arg("options"))
        .def("aim",
             [](Session &self, double force, double x, double y, double duration) {
                 const nt_input input = {force, x, y, duration};
                 raise_on(nt_session_aim(self.handle, &input), "operator input");
             })
        .def("advance", &advance_session)
        .def("read", &read_records)
        .def("arm",
             [](Session &self, bool confirmed) {
                 raise_on(alone(self, [=](nt_session *handle) { return nt_session_arm(handle, confirmed); }), "arm");
             })
        .def("inject",
             [](Session &self, const py::tuple &entry) {
                 const nt_fault fault = fault_of(entry);
                 raise_on(alone(self, [&](nt_session *handle) { return nt_session_inject(handle, &fault); }), "fault");
             })
        .def_property_readonly("is_dynamic",
                               [](const Session &self) { return nt_session_is_dynamic(self.handle) != 0; })
        .def("emergency_stop", // never waits for another call
             [](Session &self, bool pressed) { nt_session_emergency_stop(self.handle, pressed); })
        .def_property_readonly("plan", py::cpp_function(
                                           [](const Session &self) {
                                               auto copy = std::make_unique<nt_plan>();
                                               nt_plan_copy(copy.get(), nt_session_plan(self.handle));
                                               return copy;
                                           },
                                           py::keep_alive<0, 1>())) // it borrows the surface
        .def_property_readonly("margin", [](const Session &self) { return nt_session_margins(self.handle).margin; })
        .def_property_readonly("master_start", [](const Session &self) { return nt_session_master_start(self.handle); })
        .def_property_readonly("start_height",
                               [](const Session &self) { return nt_session_start_height(self.handle); });
}
