# Cross-builds for arm64 (docs/platforms.md): cmake -DCMAKE_TOOLCHAIN_FILE=cmake/aarch64.cmake -DAFM_SYSROOT=ROOT
# AFM_SYSROOT: the root of a Debian arm64 system of the same release, with the development packages. Tests run by qemu.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)

set(AFM_SYSROOT "" CACHE PATH "Root of an arm64 system with the development packages")
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES AFM_SYSROOT)
set(CMAKE_SYSROOT ${AFM_SYSROOT})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)  # Python and the generators of messages run here
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE BOTH)  # catkin looks up files in the build directory too
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)

# pybind11 asks the Python of this machine, whose suffix names x86_64; every Python takes the plain one
set(PYTHON_MODULE_EXTENSION .so)

find_program(AFM_QEMU NAMES qemu-aarch64-static qemu-aarch64)
if(AFM_QEMU)
  set(CMAKE_CROSSCOMPILING_EMULATOR ${AFM_QEMU} -L ${AFM_SYSROOT})
endif()
