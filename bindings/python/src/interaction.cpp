// SPDX-License-Identifier: BSD-3-Clause
// interaction.h: one contact, its history and its force
#include "internal/interaction.h"
#include "chapters.h"

namespace
{

// One contact; the plan is kept alive by the Python object.
struct Interaction {
    const nt_plan *plan;
    nt_interaction_state state;
    nt_slide slide;
};

} // namespace

static_assert(sizeof(nt_pose) == 3 * sizeof(double), "poses are rows of three numbers");
static_assert(sizeof(nt_friction_state) == 6 * sizeof(double),
              "a slide is six numbers, its place and whether it has one");
static_assert(sizeof(nt_interaction_value) == 7 * sizeof(double), "values are rows of seven numbers");

static nt_interaction_arrays arrays_of(const Array &poses, py::array_t<double> &values)
{
    if (poses.ndim() != 2 || poses.shape(1) != 3)
        throw py::value_error("poses must be rows of x, y, z");
    return {reinterpret_cast<const nt_pose *>(poses.data()),
            reinterpret_cast<nt_interaction_value *>(values.mutable_data()), static_cast<long>(poses.shape(0)), 1, 1};
}

static py::array_t<double> eval(const Interaction &self, const Array &poses)
{
    py::array_t<double> values({poses.shape(0), py::ssize_t{7}});
    const nt_interaction_arrays arrays = arrays_of(poses, values);
    py::gil_scoped_release release;
    nt_interaction_eval_n(self.plan, &self.state, &arrays);
    return values;
}

static py::array_t<double> run(Interaction &self, const Array &poses)
{
    py::array_t<double> values({poses.shape(0), py::ssize_t{7}});
    const nt_interaction_arrays arrays = arrays_of(poses, values);
    py::gil_scoped_release release;
    nt_interaction_slide_n(self.plan, &self.state, &self.slide, &arrays);
    return values;
}

// Along a path of gaps over the place (0, 0) of a flat.
static py::tuple run_gaps(Interaction &self, const Array &gaps)
{
    return map_law(gaps, [&self](double gap) {
        nt_interaction_advance_gap(self.plan, &self.state, nullptr, gap);
        return nt_interaction_eval_gap(self.plan, &self.state, nullptr, gap);
    });
}

// Many contacts of one plan: rows of (attached, dissipated, port), and of poses.
static py::tuple step(const nt_plan &plan, const Array &states, const Array &poses)
{
    if (states.ndim() != 2 || states.shape(1) != 3 || states.shape(0) != poses.shape(0))
        throw py::value_error("states must be rows of attached, dissipated, port, one to each pose");
    py::array_t<double> values({poses.shape(0), py::ssize_t{7}}), after({states.shape(0), py::ssize_t{3}});
    const nt_interaction_arrays arrays = arrays_of(poses, values);
    std::vector<nt_interaction_state> all(static_cast<size_t>(states.shape(0)));
    const double *in = states.data();
    double *out = after.mutable_data();
    {
        py::gil_scoped_release release;
        for (size_t i = 0; i < all.size(); ++i)
            all[i] = {in[3 * i] != 0.0, in[3 * i + 1], in[3 * i + 2]};
        nt_interaction_step_n(&plan, all.data(), &arrays);
        for (size_t i = 0; i < all.size(); ++i) {
            out[3 * i] = all[i].attached;
            out[3 * i + 1] = all[i].dissipated;
            out[3 * i + 2] = all[i].port;
        }
    }
    return py::make_tuple(after, values);
}

void bind_interaction(py::module_ &module)
{
    py::class_<Interaction>(module, "Interaction")
        .def(py::init([](const nt_plan &plan) { return Interaction{&plan, {0, 0.0, 0.0}, {}}; }), py::arg("plan"),
             py::keep_alive<1, 2>())
        .def("eval", &eval)
        .def("run", &run)
        .def("run_gaps", &run_gaps)
        .def("change",
             [](const Interaction &self, Interaction &changed, double x, double y, double z) {
                 const nt_pose pose = {x, y, z};
                 changed.state = self.state;
                 changed.slide = self.slide;
                 nt_interaction_change(self.plan, changed.plan, &changed.state, &pose);
             })
        .def_property(
            "slide",
            [](const Interaction &self) {
                const nt_friction_state &f = self.slide.friction;
                return py::make_tuple(self.slide.placed != 0, self.slide.x, self.slide.y, f.force[0], f.force[1],
                                      f.stiffness, f.stored, f.dissipated, f.work);
            },
            [](Interaction &self, const std::tuple<bool, std::array<double, 8>> &slide) {
                const std::array<double, 8> &v = std::get<1>(slide);
                self.slide = {{{v[2], v[3]}, v[4], v[5], v[6], v[7]}, v[0], v[1], std::get<0>(slide) ? 1 : 0};
            })
        .def_property(
            "state",
            [](const Interaction &self) {
                return py::make_tuple(self.state.attached != 0, self.state.dissipated, self.state.port);
            },
            [](Interaction &self, const std::tuple<bool, double, double> &state) {
                self.state = {std::get<0>(state) ? 1 : 0, std::get<1>(state), std::get<2>(state)};
            });
    module.def("interaction_step", &step);
    module.attr("interaction_state_size") = sizeof(nt_interaction_state);
}
