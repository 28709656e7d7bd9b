# SPDX-License-Identifier: BSD-3-Clause
# The sources of the library by layer: the plain list, also for other build systems. tools/check_layers.py, one of the
# tests, compares it with the folders.

# The portable core: C11 and libm, no heap, no operating system.
set(nanotouch_sources_core
    core/field.c
    core/lti.c
    core/materials.c
    core/random.c
    core/rig.c
    core/ring.c
    core/roots.c
    core/status.c
    core/version.c)
set(nanotouch_sources_forces
    forces/capillary.c
    forces/double_layer.c
    forces/electrostatic.c
    forces/electrostatic_probe.c
    forces/hydration.c
    forces/lennard_jones.c
    forces/point_charge.c
    forces/steric.c
    forces/vdw.c
    forces/vdw_tip.c)
set(nanotouch_sources_contact
    contact/contact.c
    contact/dmt.c
    contact/hertz.c
    contact/jkr.c
    contact/jkr_shape.c
    contact/jump.c
    contact/law.c
    contact/material.c
    contact/maugis.c
    contact/maugis_bank.c
    contact/maugis_bank_contact.c
    contact/maugis_bank_eval.c
    contact/maugis_bank_panels.c
    contact/maugis_branch.c
    contact/maugis_cells.c
    contact/maugis_control.c
    contact/maugis_kernel.c
    contact/maugis_solve.c
    contact/maugis_table.c
    contact/maugis_tier.c
    contact/reduced.c
    contact/model_error.c
    contact/rim.c
    contact/shape.c
    contact/sneddon.c
    contact/sphere.c
    contact/stage_displacement.c
    contact/tabor.c
    contact/validity.c)
set(nanotouch_sources_surface
    surface/dilation.c
    surface/dots.c
    surface/grating.c
    surface/height_field.c
    surface/radius_map.c)
set(nanotouch_sources_scene
    scene/adhesion.c
    scene/choice.c
    scene/contact.c
    scene/facts.c
    scene/interaction.c
    scene/laws.c
    scene/local.c
    scene/options.c
    scene/plan.c
    scene/scene.c
    scene/warnings.c)
set(nanotouch_sources_hal hal/hal.c)
set(nanotouch_sources_dynamics
    dynamics/cantilever.c
    dynamics/cantilever_dynamic.c
    dynamics/cantilever_model.c
    dynamics/hand.c
    dynamics/master.c
    dynamics/oscillator.c
    dynamics/sensor.c
    dynamics/stage.c)
set(nanotouch_sources_control
    control/guarantee.c
    control/impedance.c
    control/margins.c
    control/modes.c
    control/motor.c
    control/own_law.c
    control/paper_stage.c
    control/passivity.c
    control/preflight.c
    control/requests.c
    control/rescale.c
    control/sampled.c
    control/scaling.c
    control/servo.c
    control/settings.c
    control/stability.c
    control/stage_loop.c
    control/supervisor.c
    control/touch.c)
set(nanotouch_sources_sim hal/sim/faults.c hal/sim/probe.c hal/sim/sim.c)

# What needs an operating system (POSIX), the heap, libgpiod or Ceres.
set(nanotouch_sources_hosted hal/loop.c)
set(nanotouch_sources_linux hal/linux/gpio_lines.c hal/linux/gpiod.c)
set(nanotouch_sources_session session/arming.c session/run.c session/session.c)
set(nanotouch_sources_fit
    fit/baseline.cpp
    fit/batch.cpp
    fit/branch.c
    fit/contact_model.cpp
    fit/curve.cpp
    fit/custom_model.cpp
    fit/data.cpp
    fit/guess.cpp
    fit/linear.cpp
    fit/model.cpp
    fit/options.cpp
    fit/points.cpp
    fit/problem.cpp
    fit/reading.cpp
    fit/run.cpp
    fit/solve.cpp
    fit/uncertainty.cpp)
