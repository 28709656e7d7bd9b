// SPDX-License-Identifier: BSD-3-Clause
// sim.h
#include "faults.h"

nt_fault fault_of(const py::handle &entry)
{
    const auto fault = entry.cast<py::tuple>();
    return {static_cast<nt_fault_kind>(fault[0].cast<int>()), static_cast<nt_channel>(fault[1].cast<int>()),
            fault[2].cast<double>(), fault[3].cast<double>(), fault[4].cast<double>()};
}

nt_faults faults_of(const py::handle &list)
{
    nt_faults faults{};
    for (const py::handle &entry : list) {
        const nt_fault fault = fault_of(entry);
        raise_on(nt_faults_add(&faults, &fault), "faults");
    }
    return faults;
}

void bind_faults(py::module_ &module)
{
    py::list channels, kinds;
    for (int channel = 0; nt_channel_name(static_cast<nt_channel>(channel))[0] != 0; ++channel)
        channels.append(nt_channel_name(static_cast<nt_channel>(channel)));
    int count = 0;
    const nt_fault_description *descriptions = nt_fault_descriptions(&count);
    for (int kind = 0; kind < count; ++kind) {
        const nt_fault_description &d = descriptions[kind];
        kinds.append(py::make_tuple(d.name, d.unit, d.doc, d.value, d.minimum, d.maximum, d.row, d.channels));
    }
    module.attr("fault_channels") = py::tuple(channels);
    module.attr("fault_kinds") = py::tuple(kinds);
    module.attr("faults_max") = static_cast<int>(NT_FAULTS_MAX);
}
