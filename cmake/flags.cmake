# SPDX-License-Identifier: BSD-3-Clause
# Flags of our own targets, per target and never global.

# No contraction to fused multiply-add: the same bits on every machine. No -ffast-math: NaN and infinity mean something.
add_library(nanotouch_flags INTERFACE)
target_compile_options(
  nanotouch_flags
  INTERFACE $<$<C_COMPILER_ID:GNU,Clang,AppleClang>:-ffp-contract=off
            -fno-math-errno
            -fno-trapping-math
            -Wall
            -Wextra
            -Wpedantic
            -Wshadow
            -Wconversion
            -Wdouble-promotion
            $<$<COMPILE_LANGUAGE:C>:-Wmissing-prototypes>>)
if(PROJECT_IS_TOP_LEVEL AND NANOTOUCH_WERROR)
  target_compile_options(nanotouch_flags INTERFACE -Werror)
endif()

# What every target of ours shares: flags, hidden symbols, code that a shared library or a Python extension can contain.
function(nanotouch_target target)
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
               POSITION_INDEPENDENT_CODE ON)
endfunction()
