# SPDX-License-Identifier: BSD-3-Clause
# Install tree: headers, libraries, the export set of find_package(nanotouch), pkg-config files.
include(CMakePackageConfigHelpers)

set(targets nanotouch nanotouch_testing)
foreach(optional nanotouch_gpiod nanotouch_linux nanotouch_fit)
  if(TARGET ${optional})
    list(APPEND targets ${optional})
  endif()
endforeach()
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/nanotouch)

install(TARGETS ${targets} EXPORT nanotouch COMPONENT library)
install(DIRECTORY libnanotouch/include/nanotouch DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT library)
install(EXPORT nanotouch NAMESPACE nanotouch:: FILE nanotouchTargets.cmake DESTINATION ${package_dir} COMPONENT library)

get_target_property(library_type nanotouch TYPE)
configure_package_config_file(cmake/nanotouchConfig.cmake.in nanotouchConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(nanotouchConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/nanotouchConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/nanotouchConfigVersion.cmake
        DESTINATION ${package_dir} COMPONENT library)

file(RELATIVE_PATH include_from_lib ${CMAKE_INSTALL_FULL_LIBDIR} ${CMAKE_INSTALL_FULL_INCLUDEDIR})
if(CMAKE_SYSTEM_NAME STREQUAL Linux)
  set(libraries_private "-lrt -ldl")
endif()
configure_file(cmake/nanotouch.pc.in nanotouch.pc @ONLY)
set(package_files ${CMAKE_CURRENT_BINARY_DIR}/nanotouch.pc)
# A static fit needs Ceres, which ships no pkg-config file: pkg-config serves the shared one.
if(TARGET nanotouch_fit AND library_type STREQUAL SHARED_LIBRARY)
  configure_file(cmake/nanotouch-fit.pc.in nanotouch-fit.pc @ONLY)
  list(APPEND package_files ${CMAKE_CURRENT_BINARY_DIR}/nanotouch-fit.pc)
endif()
install(FILES ${package_files} DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT library)
