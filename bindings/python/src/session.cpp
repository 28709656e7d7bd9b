// SPDX-License-Identifier: BSD-3-Clause
// session.h
#include "session.h"

#include <thread>
#include <tuple>

#include "faults.h"
#include "internal/hazard.h"
#include "internal/margins.h"
#include "internal/session.h"

// Its thread may be in a law or a backend written in Python. If that is who let go of it last, another thread closes
// it.
Session::~Session()
{
    const py::gil_scoped_release release;
    if (!handle || !nt_session_runs_here(handle)) {
        nt_session_close(handle);
        return;
    }
    using Kept = std::tuple<std::shared_ptr<Surface>, std::shared_ptr<RadiusMap>, std::shared_ptr<Properties>,
                            std::shared_ptr<OwnLaw>, std::shared_ptr<Half>, std::shared_ptr<Half>>;
    auto kept = std::make_unique<Kept>(surface, radii, properties, law, master, slave);
    std::thread([handle = handle, kept = std::move(kept)]() mutable {
        nt_session_close(handle);
        const py::gil_scoped_acquire acquire;
        kept.reset();
    }).detach();
}

// A change of the scene closes the terrain that this plan borrows from, unless the plan's owner holds it.
static py::object plan_of(Session &self)
{
    auto copy = std::make_unique<nt_plan>();
    nt_terrain *terrain = alone(self, [&](nt_session *handle) {
        nt_plan_copy(copy.get(), nt_session_plan(handle));
        return nt_session_hold_terrain(handle);
    });
    const py::capsule held(terrain, [](void *one) { nt_terrain_close(static_cast<nt_terrain *>(one)); });
    py::object plan = py::cast(std::move(copy));
    py::detail::keep_alive_impl(plan, held);
    return plan;
}

void refuse_inside(const Session &self)
{
    if (self.handle && nt_session_runs_here(self.handle))
        raise(NT_E_STATE,
              "a half or a law cannot ask this of the session that is calling it: return first, or ask from "
              "another thread");
}

static void take_halves(Session &made, nt_session_setup &setup, const py::dict &options)
{
    const auto given = [&](const char *name) -> py::object {
        return options.contains(name) ? py::object(options[name]) : py::object(py::none());
    };
    made.master = half_of(given("master"), NT_HALF_MASTER);
    made.slave = half_of(given("slave"), NT_HALF_SLAVE);
    if (made.master) {
        setup.master = made.master->choice;
        setup.master_option = made.master->option.c_str();
    }
    if (made.slave) {
        setup.slave = made.slave->choice;
        setup.slave_option = made.slave->option.c_str();
    }
}

// What a half tells the user goes where Python's programs look for it.
static void say_line(void *, const char *text)
{
    const py::gil_scoped_acquire gil;
    try {
        py::module_::import("logging")
            .attr("getLogger")("nanotouch.hal")
            .attr("warning")("%s", text ? text_of(text) : py::str("(no text)"));
    } catch (py::error_already_set &) { // the interpreter shuts down
        PySys_FormatStderr("%s\n", text ? text : "");
    }
}

// What a law of one's own amounts to at the scales as they are; nothing where it is not to be tried.
static void learn_amounts(Session &self)
{
    const nt_session_setup *setup = nt_session_setup_of(self.handle);
    if (setup->settings.control.choice != NT_CONTROL_OWN || !(setup->minimum_margin > 0.0))
        return;
    Described<nt_settings> amounts{};
    const double stiffness = nt_session_plan(self.handle)->maximum_stiffness;
    self.amounts.reset();
    if (nt_margins_own_law(&setup->rig, &setup->settings, stiffness, &amounts.value) == NT_OK)
        self.amounts = std::make_unique<Described<nt_settings>>(amounts);
    self.law->rethrow();
}

static std::unique_ptr<Session> open_session(const Described<nt_scene> &scene, const Described<nt_rig> &rig,
                                             const Described<nt_settings> &settings, const py::dict &options)
{
    nt_session_setup setup = nt_session_defaults();
    setup.scene = scene.value;
    setup.rig = rig.value;
    setup.settings = settings.value;
    setup.mode = mode_of(options["mode"].cast<std::string>());
    auto made = std::make_unique<Session>();
    made->surface = options["surface"].cast<std::shared_ptr<Surface>>();
    made->radii = options["radii"].cast<std::shared_ptr<RadiusMap>>();
    setup.surface = made->surface ? &made->surface->surface : nullptr;
    setup.radii = made->radii ? &made->radii->map : nullptr;
    made->properties = options["properties"].cast<std::shared_ptr<Properties>>();
    setup.properties = made->properties ? &made->properties->properties : nullptr;
    const Array path = options["path"].cast<Array>();
    if (rig.value.stage.axes == 1.0) { // else it may be led anywhere: by inputs, scans, clients
        setup.path = path.data();
        setup.path_count = static_cast<long>(path.shape(0));
    }
    setup.x = path.at(0, 0);
    setup.y = path.at(0, 1);
    setup.clearance = options["clearance"].cast<double>();
    setup.rise = options["rise"].cast<double>();
    setup.preflight = options["preflight"].cast<bool>();
    setup.probe_model = static_cast<nt_probe_model>(options["probe_model"].cast<int>());
    setup.substep = options["substep"].cast<double>();
    const nt_faults faults = faults_of(options["faults"]);
    setup.faults = &faults;
    const auto particles = options["particles"].cast<std::shared_ptr<nt_particles>>(); // None: null
    setup.particles = particles.get();
    const auto rod = options["rod"].cast<std::shared_ptr<nt_rod>>();
    setup.rod = rod.get();
    setup.seed = options["seed"].cast<uint64_t>();
    setup.ring_capacity = options["ring_capacity"].cast<long>();
    setup.minimum_margin = options["minimum_margin"].cast<double>();
    setup.demand.relative_accuracy = options["relative_accuracy"].cast<double>();
    setup.demand.bound = static_cast<nt_bound>(options["bound"].cast<int>());
    if (!options["law"].is_none()) {
        made->law->call = options["law"];
        set_control(setup.settings, *made->law);
    }
    take_halves(*made, setup, options);
    setup.say = say_line;
    nt_problem problem{};
    const nt_status status = [&] {
        const py::gil_scoped_release release; // arming may wait for a device, or for a stage on its way
        return nt_session_open(&made->handle, &setup, &problem);
    }();
    made->rethrow(); // it has been tried
    raise_on(status, problem, "session");
    learn_amounts(*made);
    return made;
}

static py::dict guarantee_of(const Session &self)
{
    const nt_guarantee guarantee = nt_session_guarantee(self.handle);
    py::dict out;
    out["reaction_time"] = guarantee.reaction_time;
    out["speed"] = guarantee.speed;
    out["calibration"] = guarantee.calibration;
    out["motion"] = guarantee.motion;
    out["ringing"] = guarantee.ringing;
    out["snap_in"] = guarantee.snap_in;
    out["arrival"] = guarantee.arrival;
    out["noise"] = guarantee.noise;
    out["tare"] = guarantee.tare;
    out["force"] = guarantee.force;
    out["zero_drift"] = guarantee.zero_drift;
    py::dict failures;
    for (int i = 0; i < NT_FAILURES; ++i)
        failures[nt_failure_name((nt_failure)i)] = guarantee.failure[i];
    out["failures"] = failures;
    out["with_failure"] = guarantee.with_failure;
    out["indentation"] = guarantee.indentation;
    out["lateral_force"] = guarantee.lateral_force;
    out["moves_sideways"] = guarantee.moves_sideways != 0;
    out["help_time"] = guarantee.help_time;
    out["frame_drift"] = guarantee.frame_drift;
    return out;
}

static py::dict sideways_of(const Session &self)
{
    const nt_session_setup *setup = nt_session_setup_of(self.handle);
    const nt_plan *plan = nt_session_plan(self.handle);
    const nt_sideways_margins m = nt_session_sideways(self.handle);
    const nt_verdict verdict = nt_verdict_sideways(&m);
    py::dict out;
    out["loop_stiffness"] = m.loop_stiffness;
    out["loop_delay"] = m.loop_delay;
    out["margin"] = m.margin;
    out["exact_limit"] = m.exact_limit;
    out["exact_frequency"] = m.exact_frequency;
    out["coupling"] = m.coupling;
    out["coupled_margin"] = m.coupled_margin;
    out["least"] = m.loop_stiffness > 0.0 ? verdict.margin : m.coupled_margin;
    out["rule"] = verdict.rule;
    const bool shows = setup->rig.probe.lateral_stiffness > 0.0;
    const double slope = nt_session_reach(self.handle).slope;
    const nt_sideways_contact grip =
        shows ? nt_grip_of(plan, slope, setup->settings.limits.force) : nt_sideways_contact{};
    out["projected"] = nt_margins_projected(&setup->rig, &setup->settings, plan->maximum_stiffness, &grip);
    return out;
}

// Calls a request that may name a problem; its own law may have been tried.
template <class Call> static void ask(Session &self, const std::string &what, Call call)
{
    nt_problem problem{};
    const nt_status status = alone(self, [&](nt_session *handle) { return call(handle, &problem); });
    self.rethrow();
    raise_on(status, problem, what);
    learn_amounts(self);
}

static void change(Session &self, bool is_scene, const std::string &field, double value)
{
    const nt_event_kind kind = is_scene ? NT_EVENT_SCENE : NT_EVENT_SETTING;
    bool stays = false;
    const auto change = [&](nt_session *handle, nt_problem *problem) {
        const nt_status status = nt_session_change(handle, kind, field.c_str(), value, problem);
        stays = status == NT_E_ARGUMENT;
        return status;
    };
    const bool is_scale = field == "gains.alpha_p" || field == "gains.alpha_f";
    try {
        ask(self, field, change);
    } catch (py::error_already_set &refusal) {
        if (!stays)
            throw;
        const std::string why =
            is_scale ? "a scale is changed by session.rescale" : "it stays while the session is open";
        raise(NT_E_ARGUMENT, why + ": " + py::str(refusal.value()).cast<std::string>());
    }
}

static void bind_requests(py::class_<Session> &type)
{
    type.def("check", [](const Session &self, const nt_input &input) {
        nt_problem problem{};
        raise_on(nt_session_check_input(self.handle, &input, &problem), problem, "operator input");
    });
    type.def("aim",
             [](Session &self, const nt_input &input) {
                 nt_problem problem{};
                 raise_on(nt_session_aim(self.handle, &input, &problem), problem, "operator input");
             })
        .def("arm",
             [](Session &self, bool confirmed) {
                 raise_on(alone(self, [=](nt_session *handle) { return nt_session_arm(handle, confirmed); }), "arm");
             })
        .def("set_mode",
             [](Session &self, const std::string &name) {
                 const nt_mode mode = mode_of(name);
                 ask(self, "mode", [=](nt_session *h, nt_problem *p) { return nt_session_set_mode(h, mode, p); });
             })
        .def("rescale",
             [](Session &self, double alpha_p, double alpha_f) {
                 const nt_scaling scaling = {alpha_p, alpha_f};
                 ask(self, "rescale", [&](nt_session *h, nt_problem *p) { return nt_session_rescale(h, &scaling, p); });
             })
        .def("clutch",
             [](Session &self, bool open) {
                 raise_on(alone(self, [=](nt_session *handle) { return nt_session_clutch(handle, open); }), "clutch");
             })
        .def("change", &change, py::arg("is_scene"), py::arg("field"), py::arg("value"))
        .def("inject",
             [](Session &self, const py::tuple &entry) {
                 const nt_fault fault = fault_of(entry);
                 const nt_status status =
                     alone(self, [&](nt_session *handle) { return nt_session_inject(handle, &fault); });
                 if (status == NT_E_UNSUPPORTED)
                     raise(status, "fault: it belongs to a half that is not simulated");
                 raise_on(status, "fault");
             })
        .def("emergency_stop", // never waits for another call
             [](Session &self, bool pressed) { nt_session_emergency_stop(self.handle, pressed); });
}

static void bind_facts(py::class_<Session> &type)
{
    type.def_property_readonly("guarantee", &guarantee_of)
        .def_property_readonly(
            "motor_bound", [](const Session &self) { return motor_bound_as_dict(nt_session_motor_bound(self.handle)); })
        .def_property_readonly(
            "amounts",
            [](const Session &self) -> py::object { return self.amounts ? py::cast(*self.amounts) : py::none(); })
        .def_property_readonly("tare",
                               [](const Session &self) {
                                   const nt_tare tare = nt_session_tare(self.handle);
                                   return py::make_tuple(tare.deflection, tare.operator_force);
                               })
        .def_property_readonly("is_dynamic",
                               [](const Session &self) { return nt_session_is_dynamic(self.handle) != 0; })
        .def_property_readonly("plan", py::cpp_function(&plan_of, py::keep_alive<0, 1>())) // it borrows the surface
        .def_property_readonly(
            "settings",
            [](const Session &self) { return Described<nt_settings>{nt_session_setup_of(self.handle)->settings}; })
        .def_property_readonly(
            "scene", [](const Session &self) { return Described<nt_scene>{nt_session_setup_of(self.handle)->scene}; })
        .def_property_readonly("mode",
                               [](const Session &self) { return mode_name(nt_session_setup_of(self.handle)->mode); })
        .def_property_readonly("sideways", &sideways_of)
        .def_property_readonly("tap",
                               [](const Session &self) {
                                   const nt_verdict tap = nt_session_tap(self.handle);
                                   return std::make_pair(tap.margin, std::string(tap.rule));
                               })
        .def_property_readonly("margin", [](const Session &self) { return nt_session_margins(self.handle).margin; })
        .def_property_readonly("master_start", [](const Session &self) { return nt_session_master_start(self.handle); })
        .def_property_readonly("start_height",
                               [](const Session &self) { return nt_session_start_height(self.handle); });
}

// (operator force, x, y, duration): forces are a number or three of them; a position instead of a force holds the
// master.
static nt_input input_of(const py::object &force, const py::object &position, double x, double y, double duration)
{
    nt_input input{};
    const auto three = [](const py::object &given, double *out) {
        if (py::isinstance<py::sequence>(given)) {
            const auto numbers = given.cast<std::array<double, 3>>();
            std::copy(numbers.begin(), numbers.end(), out);
        } else {
            out[NT_Z] = given.cast<double>();
        }
    };
    three(force, input.operator_force);
    input.holds = !position.is_none();
    if (input.holds)
        three(position, input.master_position);
    input.x = x;
    input.y = y;
    input.duration = duration;
    return input;
}

void bind_session(py::module_ &module)
{
    py::class_<nt_input>(module, "Input")
        .def(py::init(&input_of), py::arg("force"), py::arg("position"), py::arg("x"), py::arg("y"),
             py::arg("duration"));
    py::class_<Session> type(module, "Session");
    type.def(py::init(&open_session), py::arg("scene"), py::arg("rig"), py::arg("settings"), py::arg("options"));
    bind_requests(type);
    bind_facts(type);
    bind_session_run(module, type);
    bind_sessions(module);
}
