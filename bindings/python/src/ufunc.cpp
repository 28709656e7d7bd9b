// SPDX-License-Identifier: BSD-3-Clause
#include "ufunc.h"

#include <algorithm>
#include <deque>

// numpy's C API without its headers, as pybind11 does it: the table of functions behind numpy.core's capsule, whose
// order numpy never changes (its second entry makes ufuncs).
static py::object from_loop(UfuncLoop *loop, void **data, const char *types, int inputs, int outputs, const char *name,
                            const char *doc)
{
    using Make = PyObject *(*)(UfuncLoop *, void **, const char *, int, int, int, int, const char *, const char *, int);
    const int none = -1; // neither reductions nor an identity
    py::module_ numpy = py::module_::import("numpy");
    const bool is_new = py::hasattr(numpy, "_core");
    py::module_ umath = py::module_::import(is_new ? "numpy._core._multiarray_umath" : "numpy.core._multiarray_umath");
    void **api = static_cast<void **>(PyCapsule_GetPointer(umath.attr("_UFUNC_API").ptr(), nullptr));
    if (!api)
        throw py::error_already_set();
    const Make make = reinterpret_cast<Make>(api[1]);
    PyObject *made = make(loop, data, types, 1, inputs, outputs, none, name, doc, 0);
    if (!made)
        throw py::error_already_set();
    return py::reinterpret_steal<py::object>(made);
}

py::object make_ufunc(UfuncLoop loop, void *data, int inputs, int outputs, const std::string &name,
                      const std::string &doc)
{
    struct Made { // numpy keeps pointers to these
        UfuncLoop loop;
        void *data;
        std::string types, name, doc;
    };
    static std::deque<Made> all;
    constexpr char float64 = 12; // NPY_DOUBLE
    all.push_back({loop, data, std::string(static_cast<size_t>(inputs + outputs), float64), name, doc});
    Made &made = all.back();
    return from_loop(&made.loop, &made.data, made.types.c_str(), inputs, outputs, made.name.c_str(), made.doc.c_str());
}

py::ssize_t UfuncArrays::run_end(py::ssize_t first, py::ssize_t count) const
{
    py::ssize_t end = count;
    for (int j = 0; j < inputs; ++j) {
        if (j == argument || steps[j] == 0)
            continue;
        const char *at = args[j] + first * steps[j];
        for (py::ssize_t i = first + 1; i < end; ++i)
            if (std::memcmp(at, args[j] + i * steps[j], sizeof(double)) != 0)
                end = i;
    }
    return end;
}

namespace
{
constexpr py::ssize_t size = sizeof(double), block = 256;

void evaluate_copies(const UfuncArrays &at, py::ssize_t first, py::ssize_t end, int value,
                     const std::function<void(const nt_strided &)> &over)
{
    const int outputs = value < 0 ? 4 : 1;
    double in[block], out[4][block];
    const auto address = [&at](int array, py::ssize_t i) { return at.args[array] + i * at.steps[array]; };
    for (py::ssize_t from = first; from < end; from += block) {
        const py::ssize_t count = std::min(block, end - from);
        for (py::ssize_t i = 0; i < count; ++i)
            std::memcpy(&in[i], address(at.argument, from + i), size);
        nt_strided arrays = {in, nullptr, nullptr, nullptr, nullptr, static_cast<long>(count), 1, 1};
        double **columns[] = {&arrays.U, &arrays.F, &arrays.k, &arrays.a};
        for (int j = 0; j < outputs; ++j)
            *columns[value < 0 ? j : value] = out[j];
        over(arrays);
        for (int j = 0; j < outputs; ++j)
            for (py::ssize_t i = 0; i < count; ++i)
                std::memcpy(address(at.inputs + j, from + i), &out[j][i], size);
    }
}
} // namespace

void UfuncArrays::evaluate(py::ssize_t first, py::ssize_t end, int value,
                           const std::function<void(const nt_strided &)> &over, bool contiguous) const
{
    const int outputs = value < 0 ? 4 : 1;
    bool whole = steps[argument] % size == 0 && steps[inputs] % size == 0;
    if (contiguous)
        whole = steps[argument] == size && steps[inputs] == size;
    for (int j = 1; j < outputs; ++j)
        whole = whole && steps[inputs + j] == steps[inputs];
    if (!whole)
        return evaluate_copies(*this, first, end, value, over);
    nt_strided arrays = {reinterpret_cast<const double *>(args[argument] + first * steps[argument]),
                         nullptr,
                         nullptr,
                         nullptr,
                         nullptr,
                         static_cast<long>(end - first),
                         static_cast<long>(steps[argument] / size),
                         static_cast<long>(steps[inputs] / size)};
    double **columns[] = {&arrays.U, &arrays.F, &arrays.k, &arrays.a};
    for (int j = 0; j < outputs; ++j)
        *columns[value < 0 ? j : value] = reinterpret_cast<double *>(args[inputs + j] + first * steps[inputs]);
    over(arrays);
}

void set_ufunc_error(nt_status status, const nt_problem &problem, const std::string &what)
{
    const py::gil_scoped_acquire gil;
    try {
        raise_on(status, problem, what);
    } catch (py::error_already_set &error) {
        error.restore();
    }
}
