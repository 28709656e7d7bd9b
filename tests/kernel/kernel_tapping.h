/* SPDX-License-Identifier: BSD-3-Clause
 * A lever that taps on the devices of the test kernel. */
#ifndef TESTS_KERNEL_TAPPING_H
#define TESTS_KERNEL_TAPPING_H

/* A test; its state is the kernel_bus. Fails where it is farther off than the steps of the converters. */
void tapping_is_the_simulated_one(void **state);

#endif
