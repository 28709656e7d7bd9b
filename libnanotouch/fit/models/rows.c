/* SPDX-License-Identifier: BSD-3-Clause
 * The rows of all models, by the list of fit_models.h. */
#include "fit/models/row.h"

#define DECLARE(constant, name) extern const nt_fit_row nt_fit_row_##name;
NT_FIT_MODEL_LIST(DECLARE)
#undef DECLARE

#define PLACE(constant, name) [NT_FIT_##constant] = &nt_fit_row_##name,
static const nt_fit_row *const rows[NT_FIT_CUSTOM] = {NT_FIT_MODEL_LIST(PLACE)};
#undef PLACE

const nt_fit_row *nt_fit_row_of(nt_fit_model model)
{
    return rows[model];
}

nt_fit_description nt_fit_describe(nt_fit_model model)
{
    if ((int)model == NT_FIT_CUSTOM)
        return (nt_fit_description){
            .name = "custom", .title = "", .law = "", .valid = "", .scaling = "", .tip = "", .sides = -1};
    return (int)model >= 0 && (int)model < NT_FIT_CUSTOM ? rows[model]->words : (nt_fit_description){.name = NULL};
}
