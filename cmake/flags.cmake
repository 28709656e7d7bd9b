# SPDX-License-Identifier: BSD-3-Clause
# Flags of our own targets, per target and never global.

# No contraction to fused multiply-add: the same bits on every machine. No -ffast-math: NaN and infinity mean something.
add_library(nanotouch_flags INTERFACE)
target_compile_options(
  nanotouch_flags
  INTERFACE $<$<C_COMPILER_ID:GNU,Clang,AppleClang>:-ffp-contract=off
            -fno-math-errno
            -fno-trapping-math
            $<$<NOT:$<PLATFORM_ID:Darwin>>:-fno-semantic-interposition> # ELF's
            -Wall
            -Wextra
            -Wpedantic
            -Wshadow
            -Wconversion
            $<$<C_COMPILER_ID:GNU>:-Wdouble-promotion> # clang takes NAN and INFINITY for floats
            # An enumerator is an int, which a double holds exactly.
            $<$<C_COMPILER_ID:Clang,AppleClang>:-Wno-enum-float-conversion>
            $<$<BOOL:${NANOTOUCH_WERROR}>:-Werror>
            $<$<COMPILE_LANGUAGE:C>:-Wmissing-prototypes>
            # isnan() and its like in mingw-w64's math.h are macros that cast to float.
            $<$<PLATFORM_ID:Windows>:-Wno-float-conversion>>)

# What every target of ours shares: flags, hidden symbols, code that a shared library or a Python extension can contain.
function(nanotouch_target target)
  # Bare metal loads a program where it was linked, and a plain linker script does not copy a table of addresses (.got).
  if(CMAKE_SYSTEM_NAME STREQUAL Generic)
    set(pic OFF)
  else()
    set(pic ON)
  endif()
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:nanotouch_flags>)
  set_target_properties(
    ${target}
    PROPERTIES C_STANDARD 11
               C_STANDARD_REQUIRED ON
               C_EXTENSIONS OFF
               CXX_STANDARD 17
               CXX_STANDARD_REQUIRED ON
               CXX_EXTENSIONS OFF
               C_VISIBILITY_PRESET hidden
               CXX_VISIBILITY_PRESET hidden
               VISIBILITY_INLINES_HIDDEN ON
               POSITION_INDEPENDENT_CODE ${pic})
endfunction()

# A library that is installed: versioned, and exporting nt_* only, also where it contains a static library of others.
set(nanotouch_exports ${CMAKE_CURRENT_LIST_DIR}/exports.map)
function(nanotouch_library target)
  nanotouch_target(${target})
  set_target_properties(${target} PROPERTIES VERSION ${PROJECT_VERSION}
                                             SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  get_target_property(type ${target} TYPE)
  if(type STREQUAL SHARED_LIBRARY AND CMAKE_SYSTEM_NAME STREQUAL Linux)
    target_link_options(${target} PRIVATE LINKER:--version-script=${nanotouch_exports} LINKER:-Bsymbolic-functions)
    set_target_properties(${target} PROPERTIES LINK_DEPENDS ${nanotouch_exports})
  endif()
endfunction()
