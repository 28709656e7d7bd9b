# SPDX-License-Identifier: BSD-3-Clause
# Bare-metal Cortex-M4 with a single-precision FPU. Debian: gcc-arm-none-eabi libnewlib-arm-none-eabi
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR cortex-m4)
set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_C_FLAGS_INIT "-mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard -ffunction-sections -fdata-sections")
set(CMAKE_EXE_LINKER_FLAGS_INIT "--specs=nosys.specs -Wl,--gc-sections")
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
find_program(QEMU_SYSTEM_ARM qemu-system-arm) # Debian: qemu-system-arm; without it what is linked does not run
if(QEMU_SYSTEM_ARM)
  set(CMAKE_CROSSCOMPILING_EMULATOR
      ${QEMU_SYSTEM_ARM} -M mps2-an386 -icount shift=0 -nographic -monitor none -serial none -semihosting-config enable=on,target=native -kernel)
endif()
