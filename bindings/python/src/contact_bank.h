// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <vector>

#include "chapters.h"

// A bank and the memory it was made in.
struct Bank {
    std::vector<nt_maugis_panel> panels;
    std::vector<nt_maugis_bank_cell> cells;
    nt_maugis_bank bank;
};
