// SPDX-License-Identifier: BSD-3-Clause
// maugis.h: many contacts, each its own.
#include <memory>
#include <vector>

#include "chapters.h"
#include "internal/maugis.h"

// A bank and the memory it was made in.
struct Bank {
    std::vector<nt_maugis_panel> panels;
    std::vector<nt_maugis_bank_cell> cells;
    nt_maugis_bank bank;
};

static_assert(sizeof(nt_contact) == 4 * sizeof(double), "a row of numbers is a contact");

static std::shared_ptr<Bank> make(double lambda_min, double lambda_max, double largest_indentation, int panels,
                                  int cells)
{
    const nt_maugis_bank_options options = {lambda_min, lambda_max, largest_indentation, panels, cells};
    auto made = std::make_shared<Bank>();
    nt_maugis_bank_memory memory{};
    raise_on(nt_maugis_bank_size(&options, &memory), "bank of tables");
    made->panels.resize(static_cast<size_t>(memory.panel_capacity));
    made->cells.resize(static_cast<size_t>(memory.cell_capacity));
    memory.panels = made->panels.data();
    memory.cells = made->cells.data();
    nt_status status;
    {
        py::gil_scoped_release release;
        status = nt_maugis_bank_init(&made->bank, &options, &memory);
    }
    raise_on(status, "bank of tables");
    return made;
}

// One contact (R, E*, w, sigma0) a row.
static const nt_contact *contacts_of(const Array &rows)
{
    if (rows.ndim() != 2 || rows.shape(1) != 4)
        throw py::value_error("contacts must be an array (n, 4)");
    return reinterpret_cast<const nt_contact *>(rows.data());
}

// Rows {U, F, k, a, dU/dR}; what fails is NaN.
static py::array_t<double> eval(const Bank &self, const Array &contacts, const Array &indentation, int branch)
{
    const long count = static_cast<long>(indentation.size());
    const nt_contact *each = contacts_of(contacts);
    if (contacts.shape(0) != count && contacts.shape(0) != 1)
        throw py::value_error("one contact for each indentation, or one for all");
    py::array_t<double> out({py::ssize_t{5}, static_cast<py::ssize_t>(count)});
    double *column = out.mutable_data();
    const nt_bank_pairs pairs = {each,
                                 indentation.data(),
                                 column,
                                 column + count,
                                 column + 2 * count,
                                 column + 3 * count,
                                 column + 4 * count,
                                 count,
                                 contacts.shape(0) == 1 ? 0 : 1,
                                 1,
                                 1};
    py::gil_scoped_release release;
    (void)nt_maugis_bank_pairs_n(&self.bank, static_cast<nt_branch>(branch), &pairs);
    return out;
}

static py::array_t<double> grip_indentation(const Bank &self, const Array &contacts)
{
    const nt_contact *each = contacts_of(contacts);
    py::array_t<double> out(contacts.shape(0));
    double *d = out.mutable_data();
    for (py::ssize_t i = 0; i < contacts.shape(0); ++i)
        d[i] = nt_maugis_bank_grip_indentation(&self.bank, &each[i]);
    return out;
}

void bind_maugis_bank(py::module_ &module)
{
    py::class_<Bank, std::shared_ptr<Bank>>(module, "Bank")
        .def(py::init(&make), py::arg("lambda_min"), py::arg("lambda_max"), py::arg("largest_indentation"),
             py::arg("panels_per_octave"), py::arg("cells_per_octave"))
        .def("eval", &eval, py::arg("contacts"), py::arg("indentation"), py::arg("branch"))
        .def("grip_indentation", &grip_indentation, py::arg("contacts"))
        .def_property_readonly("force_error", [](const Bank &self) { return self.bank.accuracy.force_error; })
        .def_property_readonly("size", [](const Bank &self) {
            return self.panels.size() * sizeof(nt_maugis_panel) + self.cells.size() * sizeof(nt_maugis_bank_cell);
        });
}
