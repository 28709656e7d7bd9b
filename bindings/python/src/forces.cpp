// SPDX-License-Identifier: BSD-3-Clause
// forces.h
#include <cstring>
#include <type_traits>

#include "chapters.h"

// One law of the header, what messages call it, its check and its form for arrays.
template <class Parameters> struct ForceLaw {
    const char *what;
    nt_status (*check)(const Parameters *, nt_problem *);
    void (*over)(const Parameters *, const nt_strided *);
};

// Parameters come as rows of numbers in the order of the struct: one row for all gaps, or one for each.
template <class Parameters>
static std::vector<Parameters> checked_rows(const ForceLaw<Parameters> &law, const Array &gap, const Array &rows)
{
    static_assert(std::is_trivially_copyable_v<Parameters> && sizeof(Parameters) % sizeof(double) == 0);
    constexpr py::ssize_t width = sizeof(Parameters) / sizeof(double);
    if (rows.ndim() != 2 || rows.shape(1) != width || (rows.shape(0) != 1 && rows.shape(0) != gap.size()))
        throw std::invalid_argument(std::string(law.what) + ": parameters of the wrong shape");
    std::vector<Parameters> checked(static_cast<std::size_t>(rows.shape(0)));
    for (std::size_t i = 0; i < checked.size(); ++i) {
        std::memcpy(&checked[i], rows.data(static_cast<py::ssize_t>(i), 0), sizeof(Parameters));
        nt_problem problem{};
        raise_on(law.check(&checked[i], &problem), problem, law.what);
    }
    return checked;
}

// {U, F, k, a} of the shape of the gaps, without the GIL.
template <class Parameters>
static py::tuple eval(const ForceLaw<Parameters> &law, const Array &gap, const Array &parameters)
{
    const std::vector<Parameters> rows = checked_rows(law, gap, parameters);
    const std::vector<py::ssize_t> shape(gap.shape(), gap.shape() + gap.ndim());
    py::array_t<double> U(shape), F(shape), k(shape), a(shape);
    nt_strided arrays = {gap.data(),
                         U.mutable_data(),
                         F.mutable_data(),
                         k.mutable_data(),
                         a.mutable_data(),
                         rows.size() == 1 ? static_cast<long>(gap.size()) : 1,
                         1,
                         1};
    {
        py::gil_scoped_release release;
        for (const Parameters &row : rows) {
            law.over(&row, &arrays);
            ++arrays.in, ++arrays.U, ++arrays.F, ++arrays.k, ++arrays.a;
        }
    }
    return py::make_tuple(U, F, k, a);
}

template <class Parameters> static void bind(py::module_ &module, const char *name, const ForceLaw<Parameters> &law)
{
    module.def(name, [law](const Array &gap, const Array &parameters) { return eval(law, gap, parameters); });
}

// Gaps in the order in which they are visited; returns the law's columns and whether the bridge stands at the end.
static py::tuple capillary_trace(const Array &gap, const Array &parameters, bool bridged)
{
    int state = bridged;
    const ForceLaw<nt_capillary> law = {"capillary force", &nt_capillary_check, nullptr};
    const nt_capillary capillary = checked_rows(law, gap, parameters).at(0);
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
    bind<nt_vdw>(module, "vdw_eval", {"van der Waals force", &nt_vdw_check, &nt_vdw_eval_n});
    bind<nt_vdw>(module, "vdw_derjaguin_eval", {"van der Waals force", &nt_vdw_check, &nt_vdw_derjaguin_eval_n});
    bind<nt_vdw_tip>(module, "vdw_tip_eval", {"van der Waals force", &nt_vdw_tip_check, &nt_vdw_tip_eval_n});
    bind<nt_capillary>(module, "capillary_eval", {"capillary force", &nt_capillary_check, &nt_capillary_eval_n});
    bind<nt_electrostatic>(module, "electrostatic_eval",
                           {"electrostatic force", &nt_electrostatic_check, &nt_electrostatic_eval_n});
    bind<nt_electrostatic_plate>(
        module, "electrostatic_plate_eval",
        {"electrostatic force", &nt_electrostatic_plate_check, &nt_electrostatic_plate_eval_n});
    bind<nt_electrostatic_tip>(module, "electrostatic_tip_eval",
                               {"electrostatic force", &nt_electrostatic_tip_check, &nt_electrostatic_tip_eval_n});
    bind<nt_electrostatic_lever>(
        module, "electrostatic_lever_eval",
        {"electrostatic force", &nt_electrostatic_lever_check, &nt_electrostatic_lever_eval_n});
    bind<nt_point_charge>(module, "point_charge_eval",
                          {"force of a charge", &nt_point_charge_check, &nt_point_charge_eval_n});
    bind<nt_lennard_jones>(module, "lennard_jones_eval",
                           {"Lennard-Jones force", &nt_lennard_jones_check, &nt_lennard_jones_eval_n});
    bind<nt_double_layer>(module, "double_layer_potential_eval",
                          {"double-layer force", &nt_double_layer_check, &nt_double_layer_potential_eval_n});
    bind<nt_double_layer>(module, "double_layer_charge_eval",
                          {"double-layer force", &nt_double_layer_check, &nt_double_layer_charge_eval_n});
    bind<nt_hydration>(module, "hydration_eval", {"hydration force", &nt_hydration_check, &nt_hydration_eval_n});
    bind<nt_steric>(module, "steric_eval", {"steric force", &nt_steric_check, &nt_steric_eval_n});
    bind<nt_steric>(module, "steric_exponential_eval",
                    {"steric force", &nt_steric_check, &nt_steric_exponential_eval_n});
    module.def("capillary_trace", &capillary_trace);
    module.def("kelvin_radius", &nt_kelvin_radius);
    module.def("debye_length", &nt_debye_length);
}
