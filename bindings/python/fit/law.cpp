// SPDX-License-Identifier: BSD-3-Clause
#include "law.h"

#include <algorithm>

PythonLaw::PythonLaw(const std::string &name, const py::list &parameters, const py::function &force) : force_(force)
{
    const auto keep = [this](const std::string &text) { return texts_.emplace_back(text).c_str(); };
    law.name = keep(name);
    law.count = static_cast<int>(parameters.size());
    law.force = &PythonLaw::call;
    law.context = this;
    for (int i = 0; i < law.count && i < NT_FIT_OWN; ++i) {
        const auto given = parameters[static_cast<std::size_t>(i)].cast<py::tuple>();
        law.parameter[i] = {keep(given[0].cast<std::string>()), keep(given[1].cast<std::string>()),
                            given[2].cast<double>(), given[3].cast<double>(), given[4].cast<double>()};
    }
}

void PythonLaw::rethrow()
{
    const std::exception_ptr raised = raised_;
    raised_ = nullptr;
    if (raised)
        std::rethrow_exception(raised);
}

nt_status PythonLaw::call(const nt_fit_options *options, const double *value, long count, const double *indentation,
                          double *force)
{
    auto *own = static_cast<PythonLaw *>(options->law->context);
    const py::gil_scoped_acquire acquire;
    try {
        const Array at(count, indentation), values(own->law.count, value);
        const Array found = own->force_(at, options->radius, values).cast<Array>();
        if (found.ndim() != 1 || found.size() != count)
            throw py::value_error("a model's function must return one force for each indentation");
        std::copy_n(found.data(), count, force);
        return NT_OK;
    } catch (...) {
        own->raised_ = std::current_exception();
        return NT_E_NO_CONVERGENCE;
    }
}
