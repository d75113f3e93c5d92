# SPDX-License-Identifier: BSD-3-Clause
# What every target of ours has in common, said once.
include_guard(GLOBAL)
include(GNUInstallDirs)

# The generation of the ABI, of which the inline namespace v0_2 and libpimg_core.so.0.2 have their names.
file(STRINGS "${PROJECT_SOURCE_DIR}/core/include/pimg/abi.h" PIMG_ABI_VERSION REGEX "^#define PIMG_ABI v")
string(REGEX REPLACE "^#define PIMG_ABI v" "" PIMG_ABI_VERSION "${PIMG_ABI_VERSION}")
string(REPLACE "_" "." PIMG_ABI_VERSION "${PIMG_ABI_VERSION}")

# pimg_target_defaults(<target>): language level, warnings, visibility, floating point.
function(pimg_target_defaults target)
    target_compile_features(${target} PUBLIC cxx_std_17)
    set_target_properties(${target} PROPERTIES
        CXX_EXTENSIONS OFF
        CXX_VISIBILITY_PRESET hidden
        VISIBILITY_INLINES_HIDDEN ON
        POSITION_INDEPENDENT_CODE ON)
    if(CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
        # No contraction into fused multiply-adds: the same picture gives the same bits on every machine.
        # Nobody replaces our functions by others of the same name when programs start: calls of exported ones may be
        # inlined.
        target_compile_options(${target} PRIVATE
            -Wall -Wextra -Wshadow -Wconversion -ffp-contract=off -fno-semantic-interposition)
        # Two builds of one commit give the same files, wherever they are made.
        target_compile_options(${target} PRIVATE
            "$<$<CONFIG:Release>:-ffile-prefix-map=${PROJECT_SOURCE_DIR}/=>"
            "$<$<CONFIG:Release>:-ffile-prefix-map=${PROJECT_BINARY_DIR}/=build/>")
        if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
            # GCC 12 sees uninitialised strings in the alternatives a std::variant does not hold.
            target_compile_options(${target} PRIVATE -Wno-maybe-uninitialized)
        endif()
        if(PIMG_WERROR)
            target_compile_options(${target} PRIVATE -Werror)
        endif()
    endif()
endfunction()

# pimg_precompile(<target> [<header>...]): parses OpenImageIO's headers, three seconds a file, and these, once for the whole
# target. Without further headers, once for all static libraries and modules, which are compiled alike.
function(pimg_precompile target)
    get_target_property(type ${target} TYPE)
    get_property(first GLOBAL PROPERTY PIMG_PRECOMPILED)
    if(type STREQUAL "MODULE_LIBRARY")
        set_target_properties(${target} PROPERTIES DEFINE_SYMBOL "")  # a macro of one target is not in the others' headers
    endif()
    if(first AND NOT ARGN AND type MATCHES "^(STATIC|MODULE)_LIBRARY$")
        target_precompile_headers(${target} REUSE_FROM ${first})
        return()
    endif()
    target_precompile_headers(${target} PRIVATE
        <functional> <string> <vector>
        <OpenImageIO/filesystem.h> <OpenImageIO/imagebuf.h> <OpenImageIO/imagebufalgo.h> <OpenImageIO/strutil.h> ${ARGN})
    if(NOT ARGN AND type STREQUAL "STATIC_LIBRARY")
        set_property(GLOBAL PROPERTY PIMG_PRECOMPILED ${target})
    endif()
endfunction()

# pimg_install_manual(<file> <program>): the manual of a program, compressed if it goes into a package.
function(pimg_install_manual file program)
    set(folder "${CMAKE_INSTALL_MANDIR}/man1")
    if(PIMG_PACKAGING)  # Debian's policy; -n: neither name nor time goes in
        set(packed "${CMAKE_CURRENT_BINARY_DIR}/${program}.1.gz")
        install(CODE "execute_process(COMMAND gzip -9 -n -c \"${file}\" OUTPUT_FILE \"${packed}\"
            COMMAND_ERROR_IS_FATAL ANY)" COMPONENT tools)
        install(FILES "${packed}" DESTINATION "${folder}" COMPONENT tools)
    else()
        install(FILES "${file}" DESTINATION "${folder}" RENAME ${program}.1 COMPONENT tools)
    endif()
endfunction()

# pimg_install_rpath(<target> <destination>): where a target that is installed there finds our shared libraries; nothing if
# they are static, or part of it.
function(pimg_install_rpath target destination)
    if(BUILD_SHARED_LIBS AND CMAKE_SYSTEM_NAME STREQUAL "Linux")
        cmake_path(ABSOLUTE_PATH destination BASE_DIRECTORY "${CMAKE_INSTALL_PREFIX}" NORMALIZE)
        cmake_path(RELATIVE_PATH CMAKE_INSTALL_FULL_LIBDIR BASE_DIRECTORY "${destination}" OUTPUT_VARIABLE libraries)
        set_target_properties(${target} PROPERTIES INSTALL_RPATH "$ORIGIN/${libraries}")
    endif()
endfunction()

# pimg_shared_library(<target> <name>): name, generation and exported symbols of the shared library pimg_<name>.
function(pimg_shared_library target name)
    set_target_properties(${target} PROPERTIES
        OUTPUT_NAME pimg_${name}
        VERSION ${PROJECT_VERSION}
        SOVERSION ${PIMG_ABI_VERSION}
        DEFINE_SYMBOL "")
    if(CMAKE_SYSTEM_NAME STREQUAL "Linux")
        set(map "${PROJECT_SOURCE_DIR}/cmake/pimg.map")
        set_target_properties(${target} PROPERTIES LINK_DEPENDS "${map}")
        target_link_options(${target} PRIVATE -Wl,-z,defs "-Wl,--version-script=${map}")
    endif()
endfunction()

# pimg_add_library(<name> HEADERS ... DETAIL_HEADERS ... SOURCES ...): the library pimg_<name>, used and exported as
# pimg::<name>; shared if BUILD_SHARED_LIBS is on. Its public headers are in include/pimg beside the caller or, when
# generated, in its build folder. Detail headers, in include/pimg/detail, are for our other libraries and are not
# installed.
function(pimg_add_library name)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "HEADERS;DETAIL_HEADERS;SOURCES")
    set(target pimg_${name})
    set(type STATIC)
    if(BUILD_SHARED_LIBS)
        set(type SHARED)
    endif()
    add_library(${target} ${type} ${arg_SOURCES})
    add_library(pimg::${name} ALIAS ${target})
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
    pimg_target_defaults(${target})
    if(BUILD_SHARED_LIBS)
        pimg_shared_library(${target} ${name})
        pimg_install_rpath(${target} "${CMAKE_INSTALL_LIBDIR}")
    endif()
    target_sources(${target} PUBLIC FILE_SET HEADERS
        BASE_DIRS include ${CMAKE_CURRENT_BINARY_DIR}/include
        FILES ${arg_HEADERS})
    target_sources(${target} PRIVATE ${arg_DETAIL_HEADERS})
    target_include_directories(${target} PRIVATE src)
    install(TARGETS ${target} EXPORT pimg_${name}
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime NAMELINK_COMPONENT dev
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev
        FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)
    install(EXPORT pimg_${name} NAMESPACE pimg:: FILE pimg_${name}.cmake
        DESTINATION ${PIMG_INSTALL_CMAKEDIR} COMPONENT dev)
endfunction()

# pimg_vector_sources(<name> <source>...): sources of pimg_<name> that Highway compiles once per instruction set, chosen at run
# time; every one gives the same bits. EMU128 is the portable baseline: the compiler bug it is held back for concerns
# 16-bit integers, which are not used.
# On ARM it is NEON: vectors of SVE have no size, and cannot be in arrays. What Highway calls NEON includes AES, which the
# whole source is compiled for, as GCC does not inline NEON into constructors otherwise; no code of ours uses AES.
function(pimg_vector_sources name)
    set(disabled "HWY_SSSE3|HWY_AVX3_DL")
    if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)$")
        set(disabled "HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128")
        set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_OPTIONS "-march=armv8-a+crypto")
    endif()
    set_source_files_properties(${ARGN} PROPERTIES
        COMPILE_DEFINITIONS "HWY_BROKEN_EMU128=0;HWY_DISABLED_TARGETS=(${disabled})")
endfunction()

# The vector code in one vector width, of inlined functions by the hundred, is what clang takes minutes to instrument: the
# fuzzers look for what bytes do, and it sees none of them before they were checked.
function(pimg_uninstrumented_when_fuzzed)
    if(PIMG_BUILD_FUZZERS)
        set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS "-fno-sanitize=all")
    endif()
endfunction()
