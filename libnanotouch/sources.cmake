# SPDX-License-Identifier: BSD-3-Clause
# The sources of the library by layer. `nanotouch_sources_portable` is the plain list for other build systems: C11 and libm.
foreach(layer core forces contact surface scene dynamics control hal/sim session)
  file(GLOB found CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_LIST_DIR} ${CMAKE_CURRENT_LIST_DIR}/${layer}/*.c)
  string(REPLACE hal/ "" name ${layer})
  set(nanotouch_sources_${name} ${found})
endforeach()
file(GLOB nanotouch_sources_hal CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_LIST_DIR} ${CMAKE_CURRENT_LIST_DIR}/hal/*.c)
file(GLOB nanotouch_sources_linux CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_LIST_DIR} ${CMAKE_CURRENT_LIST_DIR}/hal/linux/*.c)
set(nanotouch_sources_hosted hal/hal.c hal/loop.c)
list(REMOVE_ITEM nanotouch_sources_hal ${nanotouch_sources_hosted})
