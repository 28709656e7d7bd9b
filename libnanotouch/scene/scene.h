/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what scene.h does not promise. */
#ifndef NANOTOUCH_SCENE_SCENE_PRIVATE_H
#define NANOTOUCH_SCENE_SCENE_PRIVATE_H

#include "nanotouch/scene.h"

/* Of a scene that has been checked: by its medium, its adhesion and whether a meniscus forms. */
nt_adhesion_source nt_scene_adhesion_source(const nt_scene *scene);
/* r1: as given, or by the Kelvin equation from humidity and temperature [m]. */
double nt_scene_meniscus_radius(const nt_scene *scene);
/* U between conductors that are connected, 0 for others and in a liquid, where ions screen it [V]. */
double nt_scene_potential(const nt_scene *scene);
/* The tip's shape, checked with the scene. */
nt_shape nt_scene_shape(const nt_scene *scene);
/* R, E*, w and sigma0 of the scene's adhesion source; work_of_adhesion [J/m^2] stands for the w of a scene that gives a
 * measured pull-off force (a plan finds it) and is not read otherwise. */
nt_contact nt_scene_contact(const nt_scene *scene, double work_of_adhesion);

#endif
