// SPDX-License-Identifier: BSD-3-Clause
// host.h: for the programs beside this package alone
#include "internal/host.h"
#include "nanotouch/host.h"

#include <vector>

#include "descriptions.h"
#include "session.h"

using Frames1 = py::array_t<nt_frame, py::array::c_style | py::array::forcecast>;

struct LiveHost {
    std::vector<double> memory = std::vector<double>(nt_host_size() / sizeof(double) + 1);
    nt_session_host *handle = nt_host_init(memory.data());
    py::object kept; // the session, which it outlives otherwise
    Session *session = nullptr;
};

// What asks its session: one call at a time.
template <class Call> static auto hosted(LiveHost &self, Call call)
{
    if (!self.session)
        throw std::invalid_argument("host: no session is open");
    return alone(*self.session, [&](nt_session *) { return call(self.handle); });
}

static const char *const pushed_names[] = {"", "particles", "rod"};
static const char *const kind_names[] = {"scene", "rig", "settings"};

static nt_host_pushed pushed_of(const std::string &name)
{
    for (int i = NT_HOST_NOTHING; i <= NT_HOST_ROD; ++i)
        if (name == pushed_names[i])
            return static_cast<nt_host_pushed>(i);
    throw std::invalid_argument("pushed: valid are particles, rod");
}

static py::list presets()
{
    int count = 0;
    const nt_host_preset *rows = nt_host_presets(&count);
    py::list out;
    for (int i = 0; i < count; ++i)
        out.append(py::dict(py::arg("name") = rows[i].name, py::arg("title") = rows[i].title,
                            py::arg("scene") = rows[i].scene, py::arg("hint") = rows[i].hint,
                            py::arg("felt") = rows[i].felt, py::arg("accuracy") = rows[i].accuracy,
                            py::arg("pushed") = pushed_names[rows[i].pushed]));
    return out;
}

static py::list tasks()
{
    py::list out;
    for (int i = 0; const nt_host_task *task = nt_host_tasks(i); ++i)
        out.append(py::dict(py::arg("name") = task->name, py::arg("title") = task->title,
                            py::arg("preset") = task->preset, py::arg("asked") = task->asked,
                            py::arg("follows") = task->follows, py::arg("is_page") = task->is_page != 0));
    return out;
}

static py::dict slider_fields()
{
    py::dict out;
    nt_host_kind kind;
    for (int i = 0; const char *field = nt_host_slider_field(i, &kind); ++i)
        out[field] = kind_names[kind];
    return out;
}

// The sliders of a world that another program describes, too.
static std::vector<nt_host_slider> sliders(const Described<nt_scene> &scene, const Described<nt_rig> &rig,
                                           const Described<nt_settings> &settings)
{
    std::vector<nt_host_slider> rows(NT_HOST_SLIDERS);
    rows.resize(static_cast<size_t>(nt_host_sliders(&scene.value, &rig.value, &settings.value, rows.data())));
    return rows;
}

static void bind_sliders(py::module_ &module)
{
    py::class_<nt_host_slider>(module, "HostSlider")
        .def("at", &nt_host_slider_at)
        .def("place", &nt_host_slider_place)
        .def("told",
             [](const nt_host_slider &self, double value) {
                 char text[NT_HOST_LINE];
                 return std::string(nt_host_quantity(self.field, value, text, sizeof text));
             })
        .def_property_readonly("what", [](const nt_host_slider &self) { return kind_names[self.kind]; })
        .def_property_readonly("field", [](const nt_host_slider &self) { return self.field->name; })
        .def_property_readonly("unit", [](const nt_host_slider &self) { return self.field->unit; })
        .def_property_readonly("doc", [](const nt_host_slider &self) { return self.field->doc; })
        .def_readonly("title", &nt_host_slider::title)
        .def_readonly("low", &nt_host_slider::low)
        .def_readonly("high", &nt_host_slider::high);
    module.def("host_sliders", &sliders);
    module.def("host_facts", [](const Frames1 &frame, double bound, double margin, double force, double hand) {
        const nt_host_bounds bounds = {bound, margin, force, hand};
        char text[NT_HOST_LINE];
        return std::string(nt_host_facts(frame.data(), &bounds, text, sizeof text));
    });
}

static void lay(LiveHost &self, const py::dict &about)
{
    const auto text = [&](const char *name) { return about[name].cast<std::string>(); };
    const std::string name = text("name"), title = text("title"), hint = text("hint"), source = text("source"),
                      said = text("said");
    const nt_host_subject subject = {name.c_str(),
                                     title.c_str(),
                                     hint.c_str(),
                                     source.c_str(),
                                     said.c_str(),
                                     about["width"].cast<double>(),
                                     about["height"].cast<double>(),
                                     pushed_of(text("pushed"))};
    nt_host_lay(self.handle, &subject);
}

static void open(LiveHost &self, const py::object &session)
{
    self.session = &session.cast<Session &>();
    self.kept = session;
    raise_on(hosted(self, [&](nt_session_host *host) { return nt_host_open(host, self.session->handle); }), "host");
}

static void see(LiveHost &self, const Frames1 &frames)
{
    hosted(self, [&](nt_session_host *host) {
        nt_host_see(host, frames.data(), static_cast<long>(frames.size()));
        return 0;
    });
}

// Rows of start, end, radius, depth, load, and the dent that each has grown from.
static void see_dents(LiveHost &self, const std::vector<std::array<double, 8>> &rows)
{
    std::vector<nt_dent> dents(rows.size());
    for (size_t i = 0; i < rows.size(); ++i) {
        const auto &row = rows[i];
        dents[i].imprint = {{row[0], row[1]}, {row[2], row[3]}, row[4], row[5]};
        dents[i].load = row[6];
        dents[i].before = static_cast<int>(row[7]);
    }
    nt_host_see_dents(self.handle, dents.data(), static_cast<int>(dents.size()));
}

// False: the host does not know it.
static bool ask(LiveHost &self, const std::string &what, const std::string &text, std::array<double, 3> values)
{
    const nt_host_asked asked = {what.c_str(), text.c_str(), {values[0], values[1], values[2]}};
    return hosted(self, [&](nt_session_host *host) { return nt_host_ask(host, &asked); }) != NT_E_UNSUPPORTED;
}

static py::list tell(LiveHost &self)
{
    std::vector<char> text(NT_HOST_MESSAGE);
    py::list out;
    while (hosted(self, [&](nt_session_host *host) { return nt_host_tell(host, text.data(), text.size()); }) > 0)
        out.append(py::str(text.data()));
    return out;
}

static std::string result(LiveHost &self)
{
    std::vector<char> text(NT_HOST_MESSAGE);
    std::string out;
    for (long at = 0; nt_host_result(self.handle, &at, text.data(), text.size()) > 0;)
        out += text.data();
    return out;
}

static py::object change_of(const nt_host_change *change)
{
    if (!change)
        return py::none();
    return py::make_tuple(kind_names[change->kind], change->field, change->after);
}

// Settings and clearance of a session to open: {relief, width, height, clearance, keeps}; the rig gets its hand.
static py::tuple compose(LiveHost &self, const Described<nt_scene> &scene, Described<nt_rig> &rig, double accuracy,
                         const py::dict &about)
{
    auto setup = std::make_unique<nt_session_setup>(nt_session_defaults());
    setup->scene = scene.value;
    setup->rig = rig.value;
    setup->demand.relative_accuracy = accuracy;
    const auto number = [&](const char *name) { return about[name].cast<double>(); };
    const nt_host_ground ground = {number("width"), number("height"), number("relief"), number("clearance"),
                                   about["keeps"].cast<bool>()};
    nt_problem problem{};
    raise_on(nt_host_compose(self.handle, setup.get(), &ground, &problem), problem, "session");
    rig.value = setup->rig;
    return py::make_tuple(Described<nt_settings>{setup->settings}, setup->clearance);
}

// Steps its session; what a recorded one would keep is let go.
static nt_status advance(void *context, double duration)
{
    LiveHost &self = *static_cast<LiveHost *>(context);
    nt_session *session = self.session->handle;
    const double rate = nt_session_setup_of(session)->settings.gains.rate;
    const long pieces = std::max(1L, std::lround(100.0 * duration));
    std::vector<nt_record> records(4096);
    std::vector<nt_event> events(256);
    for (long i = 0; i < pieces; ++i) {
        for (long ticks = std::lround(0.01 * rate); ticks > 0; --ticks) {
            nt_frame frame;
            if (const nt_status status = nt_session_step(session, nullptr, &frame))
                return status;
            nt_host_see(self.handle, &frame, 1);
        }
        nt_session_read(session, records.data(), static_cast<long>(records.size()));
        nt_session_read_events(session, events.data(), static_cast<long>(events.size()));
        if (const nt_dents *dents = nt_session_dents(session))
            nt_host_see_dents(self.handle, dents->made, dents->count);
        nt_host_follow(self.handle, 0.01);
    }
    return NT_OK;
}

static void bind_host_itself(py::module_ &module)
{
    py::class_<LiveHost>(module, "LiveHost")
        .def(py::init())
        .def("lay", &lay)
        .def("open", &open)
        .def("see", &see)
        .def("see_dents", &see_dents)
        .def("follow",
             [](LiveHost &self, double elapsed) {
                 hosted(self, [=](nt_session_host *host) { return nt_host_follow(host, elapsed), 0; });
             })
        .def("ask", &ask)
        .def("tell", &tell)
        .def("result", &result)
        .def("refuse", [](LiveHost &self, const std::string &why) { nt_host_refuse(self.handle, why.c_str()); })
        .def("solve",
             [](LiveHost &self) {
                 const nt_host_clock clock = {&advance, &self};
                 raise_on(hosted(self, [&](nt_session_host *host) { return nt_host_solve(host, &clock); }), "solve");
             })
        .def("advance",
             [](LiveHost &self, double duration) {
                 raise_on(hosted(self, [&](nt_session_host *) { return advance(&self, duration); }), "advance");
             })
        .def("compose", &compose)
        .def_property_readonly("reopens", [](LiveHost &self) { return change_of(nt_host_reopens(self.handle)); })
        .def_property_readonly("wants",
                               [](LiveHost &self) -> py::object {
                                   const char *name = nt_host_wants(self.handle);
                                   return name ? py::object(py::str(name)) : py::object(py::none());
                               })
        .def_property_readonly("state", [](LiveHost &self) {
            const nt_host_state state = nt_host_state_of(self.handle);
            const nt_proxy &hand = *state.hand;
            return py::dict(
                py::arg("height") = hand.height, py::arg("stiffness") = hand.stiffness, py::arg("zero") = hand.zero,
                py::arg("limit") = hand.limit, py::arg("press") = hand.press, py::arg("presses") = hand.presses != 0,
                py::arg("place") = std::vector<double>(hand.place, hand.place + NT_AXES), py::arg("undo") = state.undo,
                py::arg("acts") = state.acts != 0, py::arg("task") = state.task, py::arg("done") = state.is_done != 0,
                py::arg("energies") = std::vector<double>(state.energies, state.energies + 4));
        });
}

// A hand on the session of another program: it asks for places, and others take them there.
static nt_proxy begin_proxy(const py::dict &about)
{
    nt_proxy_facts facts{};
    const auto number = [&](const char *name) { return about[name].cast<double>(); };
    facts.alpha_p = number("alpha_p");
    facts.alpha_f = number("alpha_f");
    facts.coupling = number("coupling");
    facts.lever = number("lever");
    facts.travel = number("travel");
    facts.resolution = number("resolution");
    facts.axes = about["axes"].cast<int>();
    facts.clearance = number("clearance");
    facts.pull_off = number("pull_off");
    facts.load = number("load");
    facts.limit = number("limit");
    facts.indentation = number("indentation");
    facts.sunk = number("sunk");
    facts.start_height = number("start_height");
    facts.held = number("held");
    facts.x = number("x");
    facts.y = number("y");
    facts.width = number("width");
    facts.height = number("height");
    return nt_proxy_begin(&facts);
}

// Where it wants to go, since it was asked last; None: nowhere else.
static py::object aim_of(nt_proxy &self)
{
    if (!self.aims)
        return py::none();
    self.aims = 0;
    return py::make_tuple(self.place[0], self.place[1], self.place[2]);
}

static void bind_proxy(py::module_ &module)
{
    py::class_<nt_proxy>(module, "Proxy")
        .def(py::init(&begin_proxy))
        .def("move", [](nt_proxy &self, std::array<double, 3> way,
                        const Frames1 &frame) { return nt_proxy_move(&self, way.data(), frame.data()) != 0; })
        .def("wheel",
             [](nt_proxy &self, double steps, const Frames1 &frame) { nt_proxy_wheel(&self, steps, frame.data()); })
        .def("lift", [](nt_proxy &self, const Frames1 &frame) { nt_proxy_lift(&self, frame.data()); })
        .def("follow", [](nt_proxy &self, const Frames1 &frame,
                          double elapsed) { nt_proxy_follow(&self, frame.data(), elapsed); })
        .def("keep_sideways",
             [](nt_proxy &self) { // nothing moves it there
                 self.low[0] = self.low[1] = self.high[0] = self.high[1] = 0.0;
             })
        .def("aim", &aim_of)
        .def_readonly("stiffness", &nt_proxy::stiffness)
        .def_readonly("limit", &nt_proxy::limit)
        .def_readonly("step", &nt_proxy::step)
        .def_readwrite("height", &nt_proxy::height)
        .def_readwrite("presses", &nt_proxy::presses)
        .def_property(
            "place", [](const nt_proxy &self) { return py::make_tuple(self.place[0], self.place[1], self.place[2]); },
            [](nt_proxy &self, std::array<double, 3> place) { std::copy(place.begin(), place.end(), self.place); });
    module.attr("proxy_load") = NT_PROXY_LOAD;
    module.attr("proxy_glide") = NT_PROXY_GLIDE;
}

void bind_host(py::module_ &module)
{
    module.def("host_presets", &presets);
    module.def("host_tasks", &tasks);
    module.def("host_slider_fields", &slider_fields);
    bind_sliders(module);
    bind_host_itself(module);
    bind_proxy(module);
}
