/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what the public header does not have. */
#ifndef NANOTOUCH_CONTACT_MAUGIS_BANK_PRIVATE_H
#define NANOTOUCH_CONTACT_MAUGIS_BANK_PRIVATE_H

#include "nanotouch/advanced/maugis.h"

/* Reduced {U, F, k, a} at a lambda and reduced indentation. */
nt_status nt_maugis_bank_eval(const nt_maugis_bank *bank, double lambda, double d, nt_branch branch,
                              nt_law_value *reduced);
/* In SI for a contact, which is not checked (nt_contact_check); w = 0 is Hertz. */
nt_status nt_maugis_bank_eval_contact(const nt_maugis_bank *bank, const nt_contact *contact, double indentation,
                                      nt_branch branch, nt_law_value *value);

#endif
