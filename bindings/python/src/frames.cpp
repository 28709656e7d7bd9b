// SPDX-License-Identifier: BSD-3-Clause
// frames.h, observer.h
#include "frames.h"
#include "nanotouch/advanced/observer.h"

#include <algorithm>
#include <optional>
#include <vector>

static std::unique_ptr<Frames> create_frames(const std::optional<std::string> &name)
{
    auto made = std::make_unique<Frames>();
    raise_on(nt_frames_create(&made->handle, name ? name->c_str() : nullptr), "frames");
    return made;
}

static void publish_rows(Frames &self, const py::array_t<nt_frame, py::array::c_style> &rows)
{
    for (py::ssize_t i = 0; i < rows.size(); ++i)
        nt_frames_publish(self.open(), rows.data() + i);
}

static void bind_writer(py::module_ &module)
{
    py::class_<Frames>(module, "Frames")
        .def(py::init(&create_frames), py::arg("name"))
        .def("publish", &publish_rows)
        .def("beat", [](Frames &self) { nt_frames_beat(self.open()); })
        .def("describe",
             [](Frames &self, const std::string &text) {
                 raise_on(nt_frames_describe(self.open(), text.c_str()), "description");
             })
        .def("take",
             [](Frames &self) -> py::object {
                 nt_request request;
                 if (!nt_frames_take(self.open(), &request))
                     return py::none();
                 return py::make_tuple(request.id, request.kind, request.field,
                                       std::vector<double>(request.value, request.value + 4));
             })
        .def("answer",
             [](Frames &self, uint64_t id, uint64_t tick, int status, bool pending) {
                 const nt_answer answer = {id, tick, status, pending};
                 nt_frames_answer(self.open(), &answer);
             })
        .def("close", &Frames::close);
}

static py::array_t<nt_frame> read_frames(Observer &self, long count)
{
    std::vector<nt_frame> frames(static_cast<size_t>(std::clamp(count, 0L, static_cast<long>(NT_FRAME_SLOTS))));
    const long got = nt_observer_read(self.open(), frames.data(), static_cast<long>(frames.size()));
    return py::array_t<nt_frame>(got, frames.data());
}

static py::object newest_frame(const Observer &self)
{
    nt_frame frame;
    if (!nt_observer_newest(self.open(), &frame))
        return py::none();
    return py::array_t<nt_frame>(1, &frame)[py::int_(0)];
}

static py::tuple description_of(const Observer &self)
{
    std::vector<char> text(NT_DESCRIPTION_SIZE);
    uint32_t changes = 0;
    raise_on(nt_observer_description(self.open(), text.data(), &changes), "description");
    const std::string found(text.data());
    PyObject *decoded = PyUnicode_DecodeUTF8(found.data(), static_cast<Py_ssize_t>(found.size()), "replace");
    return py::make_tuple(py::reinterpret_steal<py::object>(decoded), changes);
}

void bind_frames(py::module_ &module)
{
    PYBIND11_NUMPY_DTYPE(nt_frame, size, version, sequence, time, tip_position, tip_force, base_height, deflection,
                         master_position, motor_force, gap, contact_radius, cohesive_radius, neck_radius, state,
                         reasons, phase, changes);
    module.attr("frame_dtype") = py::dtype::of<nt_frame>();
    module.attr("frame_slots") = NT_FRAME_SLOTS;
    bind_writer(module);
    py::class_<Observer>(module, "Observer")
        .def(py::init([](const std::string &name) {
                 auto made = std::make_unique<Observer>();
                 raise_on(nt_observer_attach(&made->handle, name.c_str()), "session");
                 return made;
             }),
             py::arg("name"))
        .def("newest", &newest_frame)
        .def("read", &read_frames)
        .def_property_readonly("missed", [](const Observer &self) { return nt_observer_missed(self.open()); })
        .def_property_readonly("silence", [](const Observer &self) { return nt_observer_silence(self.open()); })
        .def_property_readonly("alive", [](const Observer &self) { return nt_observer_is_alive(self.open()) != 0; })
        .def("description", &description_of)
        .def("close", &Observer::close);
}
