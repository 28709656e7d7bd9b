// SPDX-License-Identifier: BSD-3-Clause
// forces.h
#include <cstring>
#include <deque>
#include <type_traits>

#include "internal/forces.h"
#include "ufunc.h"

// One law of the header, what messages call it, its check and its form for arrays.
template <class Parameters> struct ForceLaw {
    const char *what;
    nt_status (*check)(const Parameters *, nt_problem *);
    void (*over)(const Parameters *, const nt_strided *);
};

// A law as a ufunc: of the gap and its parameters in the order of the struct; `value` 0 .. 3 of {U, F, k, a}, or -1.
template <class Parameters> struct ForceUfunc {
    ForceLaw<Parameters> law;
    int value;
};

template <class Parameters> constexpr int parameter_count = sizeof(Parameters) / sizeof(double);

template <class Parameters>
static void loop(char **args, const py::ssize_t *dimensions, const py::ssize_t *steps, void *data)
{
    static_assert(std::is_trivially_copyable_v<Parameters> && sizeof(Parameters) % sizeof(double) == 0);
    constexpr int count = parameter_count<Parameters>;
    const auto &self = *static_cast<const ForceUfunc<Parameters> *>(data);
    const UfuncArrays at = {args, steps, 0, 1 + count};
    const QuietFlags quiet;
    for (py::ssize_t first = 0, end = 0; first < dimensions[0]; first = end) {
        end = at.run_end(first, dimensions[0]);
        double numbers[count];
        for (int j = 0; j < count; ++j)
            numbers[j] = at.parameter(j, first);
        Parameters parameters;
        std::memcpy(&parameters, numbers, sizeof parameters);
        nt_problem problem{};
        const nt_status status = self.law.check(&parameters, &problem);
        if (status != NT_OK)
            return set_ufunc_error(status, problem, self.law.what);
        at.evaluate(first, end, self.value, [&](const nt_strided &arrays) { self.law.over(&parameters, &arrays); });
    }
}

template <class Parameters> static void bind(py::module_ &module, const char *name, const ForceLaw<Parameters> &law)
{
    module.def((std::string(name) + "_ufunc").c_str(),
               [law](int value, const std::string &given, const std::string &doc) {
                   static std::deque<ForceUfunc<Parameters>> all; // numpy keeps pointers to these
                   all.push_back({law, value});
                   return make_ufunc(&loop<Parameters>, &all.back(), 1 + parameter_count<Parameters>, value < 0 ? 4 : 1,
                                     given, doc);
               },
               py::arg("value"), py::arg("name"), py::arg("doc"));
}

// Gaps in the order in which they are visited; returns the law's columns and whether the bridge stands at the end.
static py::tuple capillary_trace(const Array &gap, const Array &parameters, bool bridged)
{
    int state = bridged;
    nt_capillary capillary;
    nt_problem problem{};
    if (parameters.size() != parameter_count<nt_capillary>)
        throw std::invalid_argument("capillary force: parameters of the wrong shape");
    std::memcpy(&capillary, parameters.data(), sizeof capillary);
    raise_on(nt_capillary_check(&capillary, &problem), problem, "capillary force");
    const std::vector<py::ssize_t> shape(gap.shape(), gap.shape() + gap.ndim());
    py::array_t<double> U(shape), F(shape), k(shape), a(shape);
    const nt_strided arrays = {gap.data(),
                               U.mutable_data(),
                               F.mutable_data(),
                               k.mutable_data(),
                               a.mutable_data(),
                               static_cast<long>(gap.size()),
                               1,
                               1};
    {
        py::gil_scoped_release release;
        nt_capillary_trace_n(&capillary, &state, &arrays);
    }
    return py::make_tuple(py::make_tuple(U, F, k, a), state != 0);
}

void bind_forces(py::module_ &module)
{
    bind<nt_vdw>(module, "vdw", {"van der Waals force", &nt_vdw_check, &nt_vdw_eval_n});
    bind<nt_vdw>(module, "vdw_derjaguin", {"van der Waals force", &nt_vdw_check, &nt_vdw_derjaguin_eval_n});
    bind<nt_vdw_tip>(module, "vdw_tip", {"van der Waals force", &nt_vdw_tip_check, &nt_vdw_tip_eval_n});
    bind<nt_capillary>(module, "capillary", {"capillary force", &nt_capillary_check, &nt_capillary_eval_n});
    bind<nt_electrostatic>(module, "electrostatic",
                           {"electrostatic force", &nt_electrostatic_check, &nt_electrostatic_eval_n});
    bind<nt_electrostatic_plate>(
        module, "electrostatic_plate",
        {"electrostatic force", &nt_electrostatic_plate_check, &nt_electrostatic_plate_eval_n});
    bind<nt_electrostatic_tip>(module, "electrostatic_tip",
                               {"electrostatic force", &nt_electrostatic_tip_check, &nt_electrostatic_tip_eval_n});
    bind<nt_electrostatic_lever>(
        module, "electrostatic_lever",
        {"electrostatic force", &nt_electrostatic_lever_check, &nt_electrostatic_lever_eval_n});
    bind<nt_point_charge>(module, "point_charge",
                          {"force of a charge", &nt_point_charge_check, &nt_point_charge_eval_n});
    bind<nt_lennard_jones>(module, "lennard_jones",
                           {"Lennard-Jones force", &nt_lennard_jones_check, &nt_lennard_jones_eval_n});
    bind<nt_double_layer>(module, "double_layer_potential",
                          {"double-layer force", &nt_double_layer_check, &nt_double_layer_potential_eval_n});
    bind<nt_double_layer>(module, "double_layer_charge",
                          {"double-layer force", &nt_double_layer_check, &nt_double_layer_charge_eval_n});
    bind<nt_hydration>(module, "hydration", {"hydration force", &nt_hydration_check, &nt_hydration_eval_n});
    bind<nt_steric>(module, "steric", {"steric force", &nt_steric_check, &nt_steric_eval_n});
    bind<nt_steric>(module, "steric_exponential", {"steric force", &nt_steric_check, &nt_steric_exponential_eval_n});
    module.def("capillary_trace", &capillary_trace);
    module.def("kelvin_radius", &nt_kelvin_radius);
    module.def("debye_length", &nt_debye_length);
}
