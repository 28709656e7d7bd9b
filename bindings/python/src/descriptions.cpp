// SPDX-License-Identifier: BSD-3-Clause
// scene.h, rig.h, settings.h: descriptions, through their tables of fields
#include "descriptions.h"
#include "nanotouch/advanced/scan.h"

template <class T>
static py::class_<Described<T>> bind_described(py::module_ &module, const char *name, const nt_field *fields, int count,
                                               T (*defaults)(), nt_status (*check)(const T *, nt_problem *))
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
        .def("copy", [](const Self &self) { return self; });
    type.attr("fields") = py::tuple(table);
    return type;
}

namespace
{

// Two functions of a gap: one gives U, F, k, the other the largest |F| from there on.
struct CustomLaw {
    py::function law, bound;
};

} // namespace

// They are called while a plan is made, from any thread. The Python side catches what they raise and gives NaN.
static nt_law_value call_law(const void *context, double gap)
{
    py::gil_scoped_acquire acquire;
    const auto [U, F, k] = static_cast<const CustomLaw *>(context)->law(gap).cast<std::tuple<double, double, double>>();
    return {U, F, k, 0.0};
}

static double call_bound(const void *context, double gap)
{
    py::gil_scoped_acquire acquire;
    return static_cast<const CustomLaw *>(context)->bound(gap).cast<double>();
}

// The laws of one's own that a scene has, in the order of its places: name, law, bound.
static void set_custom(Described<nt_scene> &scene,
                       const std::vector<std::tuple<std::string, py::function, py::function>> &laws)
{
    if (laws.size() > NT_CUSTOM_TERMS)
        throw py::value_error("a scene has at most " + std::to_string(NT_CUSTOM_TERMS) + " laws of one's own");
    auto kept = std::make_shared<std::vector<CustomLaw>>();
    for (const auto &[name, law, bound] : laws) {
        if (name.empty() || name.size() >= NT_CUSTOM_NAME)
            throw py::value_error("the name of a law has 1 to " + std::to_string(NT_CUSTOM_NAME - 1) + " bytes");
        kept->push_back({law, bound});
    }
    for (size_t i = 0; i < NT_CUSTOM_TERMS; ++i) {
        nt_custom_term &custom = scene.value.custom[i];
        custom = nt_custom_term{};
        if (i < laws.size()) {
            std::get<0>(laws[i]).copy(custom.name, NT_CUSTOM_NAME - 1);
            custom.law = &call_law;
            custom.bound = &call_bound;
            custom.context = &(*kept)[i];
        }
    }
    scene.kept = kept;
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
    bind_described<nt_scene>(module, "Scene", fields, count, nt_scene_defaults, nt_scene_check)
        .def("set_custom", &set_custom);
    module.attr("custom_terms") = static_cast<int>(NT_CUSTOM_TERMS);
    fields = nt_demand_fields(&count);
    bind_described<nt_demand>(module, "Demand", fields, count, nt_demand_defaults, nt_demand_check);
    fields = nt_rig_fields(&count);
    bind_described<nt_rig>(module, "Rig", fields, count, nt_rig_defaults, nt_rig_check);
    fields = nt_drive_fields(&count);
    bind_described<nt_drive>(module, "Drive", fields, count, nt_drive_defaults, nt_drive_check);
    fields = nt_scan_fields(&count);
    bind_described<nt_scan>(module, "Scan", fields, count, nt_scan_defaults, nt_scan_check);
    fields = nt_settings_fields(&count);
    bind_described<nt_settings>(module, "Settings", fields, count, settings_of_default_rig, nt_settings_check)
        .def("keep_to",
             [](Described<nt_settings> &settings, double load) { nt_settings_keep_to(&settings.value, load); });
    module.def("settings_for",
               [](const Described<nt_rig> &rig) { return Described<nt_settings>{nt_settings_defaults(&rig.value)}; });
    module.def("scaling_heuristic", [](const Described<nt_rig> &rig, double slave_path, double attraction) {
        const nt_scaling scaling = nt_scaling_heuristic(&rig.value, slave_path, attraction);
        return py::make_tuple(scaling.alpha_p, scaling.alpha_f);
    });
}
