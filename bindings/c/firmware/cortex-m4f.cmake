# CMake's toolchain for a Cortex-M4F.
set(CMAKE_SYSTEM_NAME Generic) # no operating system
set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_C_FLAGS_INIT
  "-ffreestanding -mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16")
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY) # a program would need your start-up code
set(RUST_TARGET thumbv7em-none-eabihf)
