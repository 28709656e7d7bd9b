// SPDX-License-Identifier: BSD-3-Clause
// Where the fit starts; private to fit/.
#pragma once

#include "model.hpp"

namespace nanotouch
{

// Fills in every initial value that is NaN; a range of adhesion that is NaN so that Maugis' lambda is as given.
// NT_E_NO_CONVERGENCE if no contact law of this kind exists within the bounds.
nt_status guess(const nt_fit_options &options, const nt_fit_data &data, double lambda, Parameters *value);

} // namespace nanotouch
