# SPDX-License-Identifier: BSD-3-Clause
# Parts that are built if what they need is found. Each has a switch PIMG_BUILD_<PART>: ON, OFF, or AUTO.
include_guard(GLOBAL)

# pimg_add_part(<folder> <help>): declares the part's switch and adds its folder, unless the switch is OFF. It is a macro, since
# the folder sets variables of its caller.
macro(pimg_add_part folder help)
    string(TOUPPER "PIMG_BUILD_${folder}" _pimg_switch)
    set(_pimg_default OFF)
    if(PROJECT_IS_TOP_LEVEL)
        set(_pimg_default AUTO)
    endif()
    set(${_pimg_switch} ${_pimg_default} CACHE STRING "${help}: ON, OFF, or AUTO, if what it needs is found")
    set_property(CACHE ${_pimg_switch} PROPERTY STRINGS AUTO ON OFF)
    if(${_pimg_switch})
        add_subdirectory(${folder})
    endif()
endmacro()

# pimg_part_needs(<result> <folder> <needs> <variable>...): the first words of a part's own CMakeLists.txt, once it has looked
# for what it needs. The result is whether all variables are true. If not, the part is left out with a message that says
# what it needs; with a switch that is ON this is an error.
function(pimg_part_needs result folder needs)
    set(${result} TRUE PARENT_SCOPE)
    foreach(variable IN LISTS ARGN)
        if(NOT ${variable})
            set(${result} FALSE PARENT_SCOPE)
            string(TOUPPER "PIMG_BUILD_${folder}" switch)
            if(${switch} STREQUAL "AUTO")
                message(STATUS "Without ${folder}/, which needs ${needs}")
            else()
                message(FATAL_ERROR "${switch}=${${switch}} needs ${needs}")
            endif()
            break()
        endif()
    endforeach()
endfunction()
