# SPDX-License-Identifier: BSD-3-Clause
# What every target of ours has in common, said once.
include_guard(GLOBAL)
include(GNUInstallDirs)

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
        target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wconversion -ffp-contract=off)
        if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
            # GCC 12 sees uninitialised strings in the alternatives a std::variant does not hold.
            target_compile_options(${target} PRIVATE -Wno-maybe-uninitialized)
        endif()
        if(PIMG_WERROR)
            target_compile_options(${target} PRIVATE -Werror)
        endif()
    endif()
endfunction()

# pimg_precompile(<target>): parses OpenImageIO's headers, three seconds a file, once for the whole target.
function(pimg_precompile target)
    target_precompile_headers(${target} PRIVATE
        <functional> <string> <vector>
        <OpenImageIO/filesystem.h> <OpenImageIO/imagebuf.h> <OpenImageIO/imagebufalgo.h> <OpenImageIO/strutil.h>)
endfunction()

# pimg_add_library(<name> HEADERS ... DETAIL_HEADERS ... SOURCES ...): the static library pimg_<name>, used and exported as
# pimg::<name>. Its public headers are in include/pimg beside the caller or, when generated, in its build folder. Detail
# headers, in include/pimg/detail, are for our other libraries and are not installed.
function(pimg_add_library name)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "HEADERS;DETAIL_HEADERS;SOURCES")
    set(target pimg_${name})
    add_library(${target} STATIC ${arg_SOURCES})
    add_library(pimg::${name} ALIAS ${target})
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
    pimg_target_defaults(${target})
    target_sources(${target} PUBLIC FILE_SET HEADERS
        BASE_DIRS include ${CMAKE_CURRENT_BINARY_DIR}/include
        FILES ${arg_HEADERS})
    target_sources(${target} PRIVATE ${arg_DETAIL_HEADERS})
    target_include_directories(${target} PRIVATE src)
    install(TARGETS ${target} EXPORT pimg_${name}
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev
        FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)
    install(EXPORT pimg_${name} NAMESPACE pimg:: FILE pimg_${name}.cmake
        DESTINATION ${PIMG_INSTALL_CMAKEDIR} COMPONENT dev)
endfunction()

# pimg_vector_sources(<name> <source>...): sources of pimg_<name> that Highway compiles once per instruction set, chosen at run
# time; every one gives the same bits. EMU128 is the portable baseline: the compiler bug it is held back for concerns
# 16-bit integers, which are not used.
function(pimg_vector_sources name)
    set_source_files_properties(${ARGN} PROPERTIES
        COMPILE_DEFINITIONS "HWY_BROKEN_EMU128=0;HWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_AVX3_DL)")
endfunction()

# The vector code in one vector width, of inlined functions by the hundred, is what clang takes minutes to instrument: the
# fuzzers look for what bytes do, and it sees none of them before they were checked.
function(pimg_uninstrumented_when_fuzzed)
    if(PIMG_BUILD_FUZZERS)
        set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS "-fno-sanitize=all")
    endif()
endfunction()
