# SPDX-License-Identifier: GPL-3.0-or-later
# Zig's Clang with its headers and libraries of macOS, by way of a script that LSGP_ZIG_CXX names; LSGP_MAC names the
# processor as Apple does.
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES LSGP_ZIG_CXX LSGP_MAC)
set(CMAKE_SYSTEM_NAME Darwin)
set(CMAKE_SYSTEM_PROCESSOR "${LSGP_MAC}")
set(CMAKE_CXX_COMPILER "${LSGP_ZIG_CXX}")
set(CMAKE_OSX_SYSROOT "" CACHE STRING "Zig brings its own")
# Binutils knows neither the format nor how to write other paths into what is linked.
set(CMAKE_STRIP /bin/true CACHE FILEPATH "strips nothing")
set(CMAKE_BUILD_WITH_INSTALL_RPATH ON)
set(CMAKE_BUILD_WITH_INSTALL_NAME_DIR ON)
