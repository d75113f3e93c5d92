# SPDX-License-Identifier: BSD-3-Clause
# Sets PIMG_PYTHON to a python3 that has OpenImageIO's module and NumPy: distributions give them to their own python3,
# which need not be the first in PATH.
include_guard(GLOBAL)

function(_pimg_python_has_modules result candidate)
    execute_process(COMMAND "${candidate}" -c "import numpy, OpenImageIO"
        RESULT_VARIABLE status OUTPUT_QUIET ERROR_QUIET)
    if(NOT status EQUAL 0)
        set(${result} FALSE PARENT_SCOPE)
    endif()
endfunction()

find_program(PIMG_PYTHON NAMES python3 PATHS /usr/bin /usr/local/bin VALIDATOR _pimg_python_has_modules
    DOC "A python3 that can import OpenImageIO and numpy")
if(PIMG_BUILD_TESTS AND NOT PIMG_PYTHON)
    message(FATAL_ERROR
        "The tests need a python3 with OpenImageIO and NumPy (Debian: python3-openimageio python3-numpy); "
        "set PIMG_PYTHON to one or PIMG_BUILD_TESTS to OFF")
endif()
