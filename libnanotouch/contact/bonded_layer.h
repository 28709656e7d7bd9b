/* SPDX-License-Identifier: BSD-3-Clause
 * An incompressible layer of thickness t, bonded to rigid ground: the law of the half-space times C(q) = 1 + Sum c_i
 * q^i, its contact radius times A(q) likewise, q = sqrt(R delta)/t (paraboloid) or delta tan(psi)/t (cone); private to
 * the library.
 *
 * The polynomials were fitted to a numerical solution of Lebedev and Ufliand's integral equation up to a = 2 t
 * (tests/python/layer_oracle.py), C to 5e-4 and A to 2e-3 of itself. The published series agree with it for small q:
 * Garcia and Garcia, Biophys. J. 114 (2018) 2923, within 2 % up to a = 0.8 t, Dimitriadis et al., Biophys. J. 82 (2002)
 * 2798, up to a = 0.3 t. */
#ifndef NANOTOUCH_CONTACT_BONDED_LAYER_H
#define NANOTOUCH_CONTACT_BONDED_LAYER_H

enum { NT_LAYER_C = 6, NT_LAYER_A = 4 };
/* c_1 .., a_1 .., and q at a = 2 t, where the polynomials end. */
#define NT_LAYER_PARABOLOID_C {1.1464, 1.1771, 2.838, -0.92627, -0.38196, 0.26385}
#define NT_LAYER_PARABOLOID_A {0.37894, 0.45592, -0.64181, 0.21715}
#define NT_LAYER_PARABOLOID_LAST 1.349
#define NT_LAYER_CONE_C {0.73276, 0.50337, 0.79952, 0.31299, -0.40823, 0.1026}
#define NT_LAYER_CONE_A {0.32647, 0.51237, -0.46915, 0.11201}
#define NT_LAYER_CONE_LAST 1.851

#endif
