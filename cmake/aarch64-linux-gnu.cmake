# SPDX-License-Identifier: BSD-3-Clause
# A toolchain file for ARM's 64-bit processors, on Debian of another architecture (g++-aarch64-linux-gnu, qemu-user). The
# environment's PIMG_ARM64_ROOT names a folder with Debian's arm64 packages of Highway, zstd and GoogleTest unpacked, which
# tests/arm64.sh makes.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_FIND_ROOT_PATH "$ENV{PIMG_ARM64_ROOT}" /usr/aarch64-linux-gnu)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_LIBDIR} "$ENV{PIMG_ARM64_ROOT}/usr/lib/aarch64-linux-gnu/pkgconfig")
set(ENV{PKG_CONFIG_SYSROOT_DIR} "$ENV{PIMG_ARM64_ROOT}")
# pkg-config's file of zstd has /usr/lib, where it is on no Debian.
set(CMAKE_EXE_LINKER_FLAGS_INIT "-L$ENV{PIMG_ARM64_ROOT}/usr/lib/aarch64-linux-gnu")
set(CMAKE_CROSSCOMPILING_EMULATOR
    env "LD_LIBRARY_PATH=$ENV{PIMG_ARM64_ROOT}/usr/lib/aarch64-linux-gnu" qemu-aarch64 -L /usr/aarch64-linux-gnu)
