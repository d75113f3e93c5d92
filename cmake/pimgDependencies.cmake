# SPDX-License-Identifier: BSD-3-Clause
# Finds OpenImageIO and OpenColorIO, working around what Debian 12's packages leave broken.
# Used by our own build and, installed beside pimgConfig.cmake, by everybody who links us.
include_guard(GLOBAL)

# Gives the targets a pkg-config module stands for the name `target` that its CMake package would have used.
macro(_pimg_target_from_pkgconfig target module)
    find_package(PkgConfig QUIET)
    if(PkgConfig_FOUND)
        pkg_check_modules(PIMG_${module} QUIET IMPORTED_TARGET GLOBAL ${module})
        if(PIMG_${module}_FOUND)
            add_library(${target} INTERFACE IMPORTED GLOBAL)
            target_link_libraries(${target} INTERFACE PkgConfig::PIMG_${module})
            set(${module}_FOUND TRUE)
            set(${module}_VERSION ${PIMG_${module}_VERSION})
        endif()
    endif()
endmacro()

# Removes directories that do not exist from the include paths of an imported target.
function(_pimg_drop_missing_includes target)
    foreach(property INTERFACE_INCLUDE_DIRECTORIES INTERFACE_SYSTEM_INCLUDE_DIRECTORIES)
        get_target_property(directories ${target} ${property})
        if(directories)
            set(present "")
            foreach(directory IN LISTS directories)
                if(directory MATCHES "\\$<" OR IS_DIRECTORY "${directory}")
                    list(APPEND present "${directory}")
                endif()
            endforeach()
            set_target_properties(${target} PROPERTIES ${property} "${present}")
        endif()
    endforeach()
endfunction()

# Sets OpenImageIO_FOUND and OpenImageIO_VERSION and provides OpenImageIO::OpenImageIO.
#
# No version is requested: OpenImageIO declares majors incompatible with each other, so a request for 2.4 would turn
# 3.x away. Compare OpenImageIO_VERSION instead.
#
# Repair 1: Debian's libopenimageio-dev names the command line tools in its targets file and stops the whole
#           configuration with an error when the package openimageio-tools is absent: pkg-config is asked then.
# Repair 2: the same file names include/opencv4, which need not exist.
macro(pimg_find_openimageio)
    if(NOT TARGET OpenImageIO::OpenImageIO)
        # Imath's package announces a missing Python library that nobody here needs.
        set(_pimg_log_level "${CMAKE_MESSAGE_LOG_LEVEL}")
        set(CMAKE_MESSAGE_LOG_LEVEL WARNING)
        find_program(PIMG_OIIOTOOL oiiotool HINTS "${OpenImageIO_DIR}/../../../bin" "${OpenImageIO_DIR}/../../../../bin"
                     DOC "The oiiotool that comes with OpenImageIO")
        mark_as_advanced(PIMG_OIIOTOOL)
        if(NOT PIMG_OIIOTOOL)
            _pimg_target_from_pkgconfig(OpenImageIO::OpenImageIO OpenImageIO)
        endif()
        if(NOT TARGET OpenImageIO::OpenImageIO)
            find_package(OpenImageIO CONFIG QUIET)
        endif()
        if(NOT TARGET OpenImageIO::OpenImageIO)
            _pimg_target_from_pkgconfig(OpenImageIO::OpenImageIO OpenImageIO)
        endif()
        foreach(_pimg_target OpenImageIO::OpenImageIO OpenImageIO::OpenImageIO_Util)
            if(TARGET ${_pimg_target})
                _pimg_drop_missing_includes(${_pimg_target})
            endif()
        endforeach()
        set(CMAKE_MESSAGE_LOG_LEVEL "${_pimg_log_level}")
        unset(_pimg_target)
        unset(_pimg_log_level)
    endif()
endmacro()

# Sets OpenColorIO_FOUND and OpenColorIO_VERSION and provides OpenColorIO::OpenColorIO.
# Debian puts the package files directly into share/cmake, where CMake does not look, and from where they derive
# the include path /include.
macro(pimg_find_opencolorio)
    if(NOT TARGET OpenColorIO::OpenColorIO)
        find_package(OpenColorIO CONFIG QUIET PATH_SUFFIXES share/cmake PATHS /usr/share/cmake /usr/local/share/cmake)
        if(NOT TARGET OpenColorIO::OpenColorIO)
            _pimg_target_from_pkgconfig(OpenColorIO::OpenColorIO OpenColorIO)
        endif()
        if(TARGET OpenColorIO::OpenColorIO)
            _pimg_drop_missing_includes(OpenColorIO::OpenColorIO)
        endif()
    endif()
endmacro()
