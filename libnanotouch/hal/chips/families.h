/* SPDX-License-Identifier: BSD-3-Clause
 * The tables of the chips, a file a family. */
#ifndef HAL_CHIPS_FAMILIES_H
#define HAL_CHIPS_FAMILIES_H

#include "nanotouch/advanced/converters.h"

enum { NT_CHIPS_AD5791 = 3, NT_CHIPS_AD5686 = 3, NT_CHIPS_AD7606 = 3, NT_CHIPS_AD7768 = 1 };

extern const nt_chip nt_chips_ad5791[NT_CHIPS_AD5791];
extern const nt_chip nt_chips_ad5686[NT_CHIPS_AD5686];
extern const nt_chip nt_chips_ad7606[NT_CHIPS_AD7606];
extern const nt_chip nt_chips_ad7768[NT_CHIPS_AD7768];

#endif
