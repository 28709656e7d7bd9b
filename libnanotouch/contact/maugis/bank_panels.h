/* SPDX-License-Identifier: BSD-3-Clause
 * Making the panels of a bank of tables of Maugis-Dugdale; private to contact/. */
#ifndef NANOTOUCH_CONTACT_MAUGIS_BANK_PANELS_H
#define NANOTOUCH_CONTACT_MAUGIS_BANK_PANELS_H

#include "contact/maugis/bank.h"

double nt_bank_lambda(double distance, int above);

/* The bits of v that name its first panel and the one after its last, of a side; equal if there is none. One panel more
 * than the range of lambda on either side, in which the exact law takes over. */
void nt_bank_names(const nt_maugis_bank_options *options, int above, uint64_t names[2]);

/* 1/Zs of all panels of a side. */
nt_status nt_bank_rate_find(const nt_maugis_bank_options *options, int above, double *rate);

/* Range and number of cells of a panel, whose rate is set. */
nt_status nt_bank_panel_plan(const nt_maugis_bank_options *options, int above, uint64_t name, nt_maugis_panel *panel);

/* The cells of the planned panels of a side. */
nt_status nt_bank_panels_fill(const nt_maugis_bank_options *options, int above, nt_maugis_panel *panels, int count,
                              nt_maugis_bank_cell *cells);

#endif
