# SPDX-License-Identifier: BSD-3-Clause
# macOS on Apple's processors, by zig's C compiler (ziglang on PyPI; PYTHON_WITH_ZIG names the Python that has it).
set(CMAKE_SYSTEM_NAME Darwin)
set(CMAKE_SYSTEM_PROCESSOR arm64)
set(CMAKE_C_COMPILER $ENV{PYTHON_WITH_ZIG})
set(CMAKE_C_COMPILER_ARG1 "-m ziglang cc -target aarch64-macos")
set(CMAKE_AR llvm-ar)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
