// SPDX-License-Identifier: BSD-3-Clause
// contact.h, maugis.h as ufuncs: a model, a branch, a tier, and a value of {U, F, k, a} or all four.
#include <array>
#include <cmath>
#include <cstring>
#include <deque>
#include <vector>

#include "contact_table.h"
#include "internal/contact.h"
#include "internal/contact_derivatives.h"
#include "internal/maugis.h"
#include "ufunc.h"

namespace
{

// The models of contact.h, and Maugis-Dugdale in its own units: (lam, d) in place of (indentation, radius, ...).
constexpr int reduced_model = NT_MAUGIS + 1;
constexpr int parameter_counts[] = {2, 3, 3, 4, 1};

struct ContactUfunc {
    int model;
    nt_branch branch;
    nt_tier tier;
    int value; // 0 .. 3 of {U, F, k, a}, or -1 for all
};

// A law made ready, and its table where one was asked for.
struct Prepared {
    int model = -1;
    std::array<double, 4> parameters{};
    nt_status status = NT_OK;
    nt_problem problem{};
    nt_contact_law law{};
    std::vector<nt_maugis_cell> cells;
    nt_maugis_table table{};
    bool has_table = false;

    void make();
};

void Prepared::make()
{
    has_table = false;
    law = {};
    problem = {};
    if (model == reduced_model) {
        const double lambda = parameters[0];
        const nt_contact contact = {1.0, 0.75, 1.0 / NT_PI, 0.0};
        law.model = NT_MAUGIS;
        status = nt_maugis_init_lambda(&law.maugis, &contact, lambda);
        if (status == NT_E_RANGE)
            problem = problem_of("lam", "", lambda, NT_MAUGIS_LAMBDA_MIN, NT_MAUGIS_LAMBDA_MAX);
        return;
    }
    nt_contact contact = {parameters[0], parameters[1], model == NT_HERTZ ? 0.0 : parameters[2],
                          model == NT_MAUGIS ? parameters[3] : 1.0};
    status = nt_contact_check(&contact, &problem);
    if (status == NT_OK)
        status = nt_contact_law_init(&law, static_cast<nt_model>(model), &contact);
}

bool wants_table(const ContactUfunc &self, const Prepared &made)
{
    return needs_table(made.law.model, self.branch, self.tier);
}

// The last laws of this thread: one is made once for all calls that follow each other, and for masked or split arrays.
Prepared &prepared(const ContactUfunc &self, const std::array<double, 4> &parameters)
{
    thread_local std::array<Prepared, 4> last;
    thread_local size_t oldest = 0;
    Prepared *found = nullptr;
    for (Prepared &one : last)
        if (one.model == self.model && std::memcmp(one.parameters.data(), parameters.data(), sizeof parameters) == 0)
            found = &one;
    if (!found) {
        found = &last[oldest];
        oldest = (oldest + 1) % last.size();
        found->model = self.model;
        found->parameters = parameters;
        found->make();
    }
    if (found->status == NT_OK && wants_table(self, *found) && !found->has_table) {
        found->status = make_table(found->law, found->cells, found->table);
        found->has_table = true;
    }
    return *found;
}

// What fails is NaN, as no branch is where it is not.
void evaluate(const ContactUfunc &self, const Prepared &made, const nt_strided &arrays)
{
    if (!wants_table(self, made))
        (void)nt_contact_law_eval_n(&made.law, self.branch, &arrays);
    else if (self.value == 1)
        (void)(self.tier == NT_TIER_TABLE ? nt_maugis_table_force_n : nt_maugis_table_polish_n)(
            &made.table, self.branch, arrays.in, arrays.F, arrays.count);
    else
        (void)nt_maugis_table_eval_n(&made.table, self.tier, self.branch, &arrays);
}

void fill_nan(const nt_strided &arrays)
{
    for (double *column : {arrays.U, arrays.F, arrays.k, arrays.a})
        for (long i = 0; column && i < arrays.count; ++i)
            column[i * arrays.out_stride] = std::nan("");
}

bool is_paired(const ContactUfunc &self)
{
    const bool is_maugis = self.model == NT_MAUGIS || self.model == reduced_model;
    return is_maugis && self.tier == NT_TIER_EXACT && self.branch != NT_BRANCH_UNSTABLE;
}

nt_contact contact_of(const ContactUfunc &self, const UfuncArrays &at, py::ssize_t i)
{
    if (self.model == reduced_model)
        return {1.0, 0.75, 1.0 / NT_PI, 0.5 * at.parameter(0, i)}; // its units are 1
    return {at.parameter(0, i), at.parameter(1, i), at.parameter(2, i), at.parameter(3, i)};
}

constexpr py::ssize_t pairs = 256; // at once
constexpr py::ssize_t few = 16;    // of a contact: not worth a block

// From `first` on, each element with its own contact: the same bits as alone. False where one fails; nothing is then
// kept, and what goes on one by one says which.
bool evaluate_pairs(const ContactUfunc &self, const UfuncArrays &at, py::ssize_t first, py::ssize_t count)
{
    std::array<nt_contact, pairs> contacts;
    double in[pairs], out[4][pairs];
    for (py::ssize_t i = 0; i < count; ++i) {
        contacts[static_cast<size_t>(i)] = contact_of(self, at, first + i);
        std::memcpy(&in[i], at.args[at.argument] + (first + i) * at.steps[at.argument], sizeof in[i]);
    }
    const nt_maugis_bank exact{};
    nt_bank_pairs arrays = {contacts.data(),          in, nullptr, nullptr, nullptr, nullptr, nullptr,
                            static_cast<long>(count), 1,  1,       1};
    double **columns[] = {&arrays.U, &arrays.F, &arrays.k, &arrays.a};
    const int outputs = self.value < 0 ? 4 : 1;
    for (int j = 0; j < outputs; ++j)
        *columns[self.value < 0 ? j : self.value] = out[j];
    if (nt_maugis_bank_pairs_n(&exact, self.branch, &arrays) != NT_OK)
        return false;
    for (int j = 0; j < outputs; ++j)
        for (py::ssize_t i = 0; i < count; ++i)
            std::memcpy(at.args[at.inputs + j] + (first + i) * at.steps[at.inputs + j], &out[j][i], sizeof(double));
    return true;
}

void loop(char **args, const py::ssize_t *dimensions, const py::ssize_t *steps, void *data)
{
    const ContactUfunc &self = *static_cast<const ContactUfunc *>(data);
    const int parameters = parameter_counts[self.model];
    const UfuncArrays at = {args, steps, self.model == reduced_model ? 1 : 0, 1 + parameters};
    const QuietFlags quiet;
    py::ssize_t single = 0; // one by one up to here
    for (py::ssize_t first = 0, end = 0; first < dimensions[0]; first = end) {
        end = at.run_end(first, dimensions[0]);
        const py::ssize_t left = std::min(pairs, dimensions[0] - first);
        if (end - first < few && left >= few && first >= single && is_paired(self)) {
            if (evaluate_pairs(self, at, first, left)) {
                end = first + left;
                continue;
            }
            single = first + left;
        }
        std::array<double, 4> values{};
        for (int j = 0; j < parameters; ++j)
            values[static_cast<size_t>(j)] = at.parameter(j, first);
        const Prepared &made = prepared(self, values);
        const bool missing = self.model == reduced_model && std::isnan(values[0]);
        if (made.status != NT_OK && !missing)
            return set_ufunc_error(made.status, made.problem, self.model == reduced_model ? "lam" : "contact");
        const auto over = [&](const nt_strided &arrays) { missing ? fill_nan(arrays) : evaluate(self, made, arrays); };
        at.evaluate(first, end, self.value, over, self.value == 1 && wants_table(self, made));
    }
}

// The derivatives of the force by every input.
void gradient_loop(char **args, const py::ssize_t *dimensions, const py::ssize_t *steps, void *data)
{
    const ContactUfunc &self = *static_cast<const ContactUfunc *>(data);
    const int inputs = 1 + parameter_counts[self.model];
    const UfuncArrays at = {args, steps, 0, inputs};
    const QuietFlags quiet;
    for (py::ssize_t first = 0, end = 0; first < dimensions[0]; first = end) {
        end = at.run_end(first, dimensions[0]);
        std::array<double, 4> values{};
        for (int j = 0; j + 1 < inputs; ++j)
            values[static_cast<size_t>(j)] = at.parameter(j, first);
        const Prepared &made = prepared(self, values);
        if (made.status != NT_OK)
            return set_ufunc_error(made.status, made.problem, "contact");
        for (py::ssize_t i = first; i < end; ++i) {
            const double none = std::nan("");
            nt_contact_derivatives found = {none, none, none, none, none};
            double indentation;
            std::memcpy(&indentation, args[0] + i * steps[0], sizeof indentation);
            (void)nt_contact_law_derivatives(&made.law, indentation, self.branch, &found);
            const double columns[] = {found.by_indentation, found.by_radius, found.by_effective_modulus,
                                      found.by_work_of_adhesion, found.by_cohesive_stress};
            for (int j = 0; j < inputs; ++j)
                std::memcpy(args[inputs + j] + i * steps[inputs + j], &columns[j], sizeof(double));
        }
    }
}

ContactUfunc *kept(int model, int branch, int tier, int value)
{
    static std::deque<ContactUfunc> all; // numpy keeps pointers to these
    all.push_back({model, static_cast<nt_branch>(branch), static_cast<nt_tier>(tier), value});
    return &all.back();
}

py::object contact_ufunc(int model, int branch, int tier, int value, const std::string &name, const std::string &doc)
{
    return make_ufunc(&loop, kept(model, branch, tier, value), 1 + parameter_counts[model], value < 0 ? 4 : 1, name,
                      doc);
}

py::object gradient_ufunc(int model, int branch, const std::string &name, const std::string &doc)
{
    const int inputs = 1 + parameter_counts[model];
    return make_ufunc(&gradient_loop, kept(model, branch, NT_TIER_EXACT, 1), inputs, inputs, name, doc);
}

} // namespace

void bind_contact_ufunc(py::module_ &module)
{
    module.def("contact_ufunc", &contact_ufunc, py::arg("model"), py::arg("branch"), py::arg("tier"), py::arg("value"),
               py::arg("name"), py::arg("doc"));
    module.def("gradient_ufunc", &gradient_ufunc, py::arg("model"), py::arg("branch"), py::arg("name"), py::arg("doc"));
}
