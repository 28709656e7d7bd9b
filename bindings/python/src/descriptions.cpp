// SPDX-License-Identifier: BSD-3-Clause
// scene.h, rig.h, control.h: descriptions, through their tables of fields
#include "descriptions.h"

template <class T>
static void bind_described(py::module_ &module, const char *name, const nt_field *fields, int count, T (*defaults)(),
                           nt_status (*check)(const T *, nt_problem *))
{
    using Self = Described<T>;
    auto find = [fields, count](const std::string &field) -> const nt_field * {
        for (int i = 0; i < count; ++i)
            if (field == fields[i].name)
                return &fields[i];
        throw py::key_error(field);
    };
    py::list table;
    for (int i = 0; i < count; ++i)
        table.append(
            py::make_tuple(fields[i].name, fields[i].unit, fields[i].minimum, fields[i].maximum, fields[i].doc));
    py::class_<Self> type(module, name);
    type.def(py::init([defaults] { return Self{defaults()}; }))
        .def("get",
             [find](const Self &self, const std::string &field) { return nt_field_get(find(field), &self.value); })
        .def("set",
             [find](Self &self, const std::string &field, double v) { nt_field_set(find(field), &self.value, v); })
        .def("check",
             [check, name = std::string(name)](const Self &self) {
                 nt_problem problem{};
                 raise_on(check(&self.value, &problem), problem, name);
             })
        .def("copy", [](const Self &self) { return Self{self.value}; });
    type.attr("fields") = py::tuple(table);
}

static nt_settings settings_of_default_rig()
{
    const nt_rig rig = nt_rig_defaults();
    return nt_settings_defaults(&rig);
}

void bind_descriptions(py::module_ &module)
{
    int count = 0;
    const nt_field *fields = nt_scene_fields(&count);
    bind_described<nt_scene>(module, "Scene", fields, count, nt_scene_defaults, nt_scene_check);
    fields = nt_demand_fields(&count);
    bind_described<nt_demand>(module, "Demand", fields, count, nt_demand_defaults, nt_demand_check);
    fields = nt_rig_fields(&count);
    bind_described<nt_rig>(module, "Rig", fields, count, nt_rig_defaults, nt_rig_check);
    fields = nt_settings_fields(&count);
    bind_described<nt_settings>(module, "Settings", fields, count, settings_of_default_rig, nt_settings_check);
    module.def("settings_for",
               [](const Described<nt_rig> &rig) { return Described<nt_settings>{nt_settings_defaults(&rig.value)}; });
    module.def("scaling_heuristic", [](const Described<nt_rig> &rig, double slave_path, double attraction) {
        const nt_scaling scaling = nt_scaling_heuristic(&rig.value, slave_path, attraction);
        return py::make_tuple(scaling.alpha_p, scaling.alpha_f);
    });
}
