/* SPDX-License-Identifier: BSD-3-Clause
 * What Maugis-Dugdale itself is worth: its distance to a sphere under the Lennard-Jones law on the same half-space,
 * both with indentation counted from where the load is 0, as measured curves are; loads from -0.9 to 10 pull-off
 * forces. Made with the tables of tools/lennard_jones (nanotouch.reference.model_error);
 * docs/evidence/lennard_jones.md. */
#include <math.h>

#include "contact/geometry.h"
#include "nanotouch/advanced/geometry.h"

#define FIRST_MU 0.05 /* the entries follow in equal steps of ln mu up to LAST_MU */
#define LAST_MU 5.0

static const double errors[] = {0.2775,  0.1793,  0.1138, 0.0699, 0.04044, 0.02067, 0.01231, 0.02209, 0.02794,
                                0.03043, 0.03008, 0.0275, 0.0235, 0.01891, 0.01445, 0.01058, 0.007476};

double nt_maugis_model_error(double lambda)
{
    enum { LAST = (int)(sizeof errors / sizeof errors[0]) - 1 };
    const double mu = lambda / NT_LAMBDA_PER_TABOR;
    if (!(mu >= FIRST_MU && mu <= LAST_MU))
        return NAN;
    const double x = log(mu / FIRST_MU) / log(LAST_MU / FIRST_MU) * LAST;
    const int i = (int)fmin(floor(x), LAST - 1.0);
    return errors[i] + (x - i) * (errors[i + 1] - errors[i]);
}
