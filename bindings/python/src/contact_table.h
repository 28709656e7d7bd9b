// SPDX-License-Identifier: BSD-3-Clause
// The table behind a contact law in the tiers that use one.
#pragma once
#include <vector>

#include "chapters.h"
#include "internal/contact.h"
#include "nanotouch/advanced/maugis.h"

// Closed forms, and the branch that no table holds, are exact in every tier.
inline bool needs_table(nt_model model, nt_branch branch, nt_tier tier)
{
    return tier != NT_TIER_EXACT && branch != NT_BRANCH_UNSTABLE && (model == NT_JKR || model == NT_MAUGIS);
}

// JKR is the table of the largest lambda. Without adhesion there are no cells: every tier is Hertz.
inline nt_status make_table(const nt_contact_law &law, std::vector<nt_maugis_cell> &cells, nt_maugis_table &table)
{
    nt_maugis maugis = law.maugis;
    if (law.model == NT_JKR) {
        const nt_status status = nt_maugis_init_lambda(&maugis, &law.maugis.contact, NT_MAUGIS_LAMBDA_MAX);
        if (status != NT_OK)
            return status;
    }
    const nt_maugis_table_options options = nt_maugis_table_defaults();
    cells.resize(static_cast<size_t>(nt_maugis_table_cells(&maugis, &options)));
    return nt_maugis_table_init(&table, &maugis, &options, cells.data(), static_cast<int>(cells.size()));
}
