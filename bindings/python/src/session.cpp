// SPDX-License-Identifier: BSD-3-Clause
// session.h
#include <memory>
#include <mutex>
#include <vector>

#include "descriptions.h"
#include "surface.h"

struct Session {
    nt_session *handle = nullptr;
    std::shared_ptr<Surface> surface; // outlives the handle
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
};

static std::unique_ptr<Session> open_session(const Described<nt_scene> &scene, const Described<nt_rig> &rig,
                                             const Described<nt_settings> &settings, std::shared_ptr<Surface> surface,
                                             py::dict options)
{
    nt_session_setup setup = nt_session_defaults();
    setup.scene = scene.value;
    setup.rig = rig.value;
    setup.settings = settings.value;
    setup.mode = options["topography"].cast<bool>() ? NT_MODE_TOPOGRAPHY : NT_MODE_TOUCH;
    setup.surface = surface ? &surface->surface : nullptr;
    setup.x = options["x"].cast<double>();
    setup.y = options["y"].cast<double>();
    setup.clearance = options["clearance"].cast<double>();
    setup.rise = options["rise"].cast<double>();
    setup.seed = options["seed"].cast<uint64_t>();
    setup.minimum_margin = options["minimum_margin"].cast<double>();
    setup.demand.relative_accuracy = options["relative_accuracy"].cast<double>();
    auto made = std::make_unique<Session>();
    made->surface = std::move(surface);
    nt_problem problem{};
    raise_on(nt_session_open(&made->handle, &setup, &problem), problem, "session");
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
    raise_on(alone(self, [ticks](nt_session *handle) { return nt_session_advance(handle, ticks); }), "advance");
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
    py::array_t<uint8_t> state(got);
    py::array_t<uint32_t> reasons(got);
    for (long i = 0; i < got; ++i) {
        state.mutable_data()[i] = static_cast<uint8_t>(records[static_cast<size_t>(i)].state);
        reasons.mutable_data()[i] = records[static_cast<size_t>(i)].reasons;
    }
    out["state"] = state;
    out["reasons"] = reasons;
    return out;
}

void bind_session(py::module_ &module)
{
    py::class_<Session>(module, "Session")
        .def(py::init(&open_session), py::arg("scene"), py::arg("rig"), py::arg("settings"), py::arg("surface"),
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
        .def("emergency_stop",
             [](Session &self, bool pressed) {
                 alone(self, [=](nt_session *handle) { nt_session_emergency_stop(handle, pressed); });
             })
        .def_property_readonly("plan", [](const Session &self) { return nt_plan(*nt_session_plan(self.handle)); })
        .def_property_readonly("margin", [](const Session &self) { return nt_session_margins(self.handle).margin; })
        .def_property_readonly("master_start", [](const Session &self) { return nt_session_master_start(self.handle); })
        .def_property_readonly("start_height",
                               [](const Session &self) { return nt_session_start_height(self.handle); });
    py::list reasons;
    for (uint32_t bit = 1; nt_reason_name(bit)[0] != 0; bit <<= 1)
        reasons.append(nt_reason_name(bit));
    module.attr("reasons") = py::tuple(reasons);
}
