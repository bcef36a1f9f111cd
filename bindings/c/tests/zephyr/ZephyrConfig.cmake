# Stands in for Zephyr's CMake package: links a library `app` into firmware for QEMU's Cortex-M4F.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_C_FLAGS_INIT "-mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16 -ffreestanding")
enable_language(C)

set(HERE ${CMAKE_CURRENT_LIST_DIR})
set(FIRMWARE ${HERE}/../../firmware)
add_library(app STATIC)
target_include_directories(app PRIVATE ${HERE})
add_executable(zephyr ${HERE}/kernel.c ${FIRMWARE}/start.c ${FIRMWARE}/semihosting.c)
target_include_directories(zephyr PRIVATE ${HERE} ${FIRMWARE})
target_link_options(zephyr PRIVATE
  -nostdlib -T${FIRMWARE}/memory.ld -Wl,--gc-sections,-z,noexecstack)
target_link_libraries(zephyr PRIVATE app)

# As Zephyr does: an option of prj.conf is a variable, and a module adds its folder.
set(ZEPHYR_BASE ${HERE})
file(STRINGS ${CMAKE_CURRENT_SOURCE_DIR}/prj.conf CONFIG_ACROBOT REGEX "^CONFIG_ACROBOT=y")
file(STRINGS ${ZEPHYR_EXTRA_MODULES}/zephyr/module.yml folder REGEX "^ +cmake: ")
string(REGEX REPLACE "^ +cmake: " "" folder ${folder})
add_subdirectory(${ZEPHYR_EXTRA_MODULES}/${folder} modules/acrobot)
