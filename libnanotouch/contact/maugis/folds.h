/* SPDX-License-Identifier: BSD-3-Clause
 * Where the contact branch of Maugis-Dugdale has its folds; private to contact/. */
#ifndef NANOTOUCH_CONTACT_MAUGIS_FOLDS_H
#define NANOTOUCH_CONTACT_MAUGIS_FOLDS_H

#include "nanotouch/contact.h"

/* y of the displacement fold; 0 where that is not on the contact branch. */
double nt_maugis_grip_parameter(double lambda);

/* Folds and ends of both branches, and fold_y, load_fold_y, of a lambda that is set and in its range. */
void nt_maugis_folds_find(nt_maugis *maugis);

#endif
