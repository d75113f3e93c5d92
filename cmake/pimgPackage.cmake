# SPDX-License-Identifier: BSD-3-Clause
# Debian packages, one for each install component: `cpack -G DEB` in a build configured with -DPIMG_PACKAGING=ON
# -DCMAKE_INSTALL_PREFIX=/usr, which is what `./dev.sh package` does. Included last: CPack reads its variables here.
include_guard(GLOBAL)

# pimg_debian_package(<component> <package> <section> <first line> <text> [<depends>])
function(pimg_debian_package component package section summary text)
    string(TOUPPER "${component}" key)
    set(depends "${ARGN}")
    string(REPLACE ";" ", " depends "${depends}")
    foreach(pair "PACKAGE_NAME:${package}" "PACKAGE_SECTION:${section}" "PACKAGE_DEPENDS:${depends}")
        string(REGEX MATCH "^([^:]*):(.*)$" matched "${pair}")
        set(CPACK_DEBIAN_${key}_${CMAKE_MATCH_1} "${CMAKE_MATCH_2}" PARENT_SCOPE)
    endforeach()
    # CPack takes the first line of a component's description as the synopsis.
    set(CPACK_COMPONENT_${key}_DESCRIPTION "${summary}\n${text}" PARENT_SCOPE)
    set(packages ${packages} ${component} PARENT_SCOPE)

    # Every package brings the licence and its history, as Debian's policy asks.
    set(documents "${CMAKE_INSTALL_DATADIR}/doc/${package}")
    install(FILES "${PROJECT_BINARY_DIR}/packaging/copyright" DESTINATION "${documents}" COMPONENT ${component})
    install(FILES "${PROJECT_BINARY_DIR}/packaging/changelog.gz" DESTINATION "${documents}"
            COMPONENT ${component})
    install(FILES "${PROJECT_SOURCE_DIR}/packaging/overrides/${package}" OPTIONAL
            DESTINATION "${CMAKE_INSTALL_DATADIR}/lintian/overrides" COMPONENT ${component})
endfunction()

file(MAKE_DIRECTORY "${PROJECT_BINARY_DIR}/packaging")
file(STRINGS "${PROJECT_SOURCE_DIR}/LICENSE" licence_lines)
set(PIMG_LICENSE_TEXT "")
foreach(line IN LISTS licence_lines)
    if(line STREQUAL "")
        set(line ".")
    endif()
    string(APPEND PIMG_LICENSE_TEXT " ${line}\n")
endforeach()
# The date of the commit, or $SOURCE_DATE_EPOCH: two builds of one commit give the same packages.
if(NOT DEFINED ENV{SOURCE_DATE_EPOCH})
    execute_process(COMMAND git log -1 --format=%ct WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}"
        OUTPUT_VARIABLE commit_time OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    if(commit_time)
        set(ENV{SOURCE_DATE_EPOCH} "${commit_time}")
    endif()
endif()
string(TIMESTAMP PIMG_CHANGELOG_DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)
configure_file("${PROJECT_SOURCE_DIR}/packaging/copyright.in" "${PROJECT_BINARY_DIR}/packaging/copyright" @ONLY)
configure_file("${PROJECT_SOURCE_DIR}/packaging/changelog.in" "${PROJECT_BINARY_DIR}/packaging/changelog" @ONLY)
# -n: neither name nor time goes in, so that two builds make the same package.
execute_process(COMMAND gzip -9 -n -f -k "${PROJECT_BINARY_DIR}/packaging/changelog" COMMAND_ERROR_IS_FATAL ANY)

set(packages "")
pimg_debian_package(runtime libpimg0 libs "progressive images for OpenImageIO: C library"
    "A progressive image is a picture as a mesh with one vertex for each pixel,\nsimplified to a base mesh and refined by vertex splits, large features first.\nThis package holds the C library that other languages load.")
pimg_debian_package(dev libpimg-dev libdevel "progressive images for OpenImageIO: development files"
    "Headers, the C++ libraries pimg::core, pimg::codec, pimg::painting and\npimg::filters, and the files for CMake and pkg-config."
    "libpimg0 (= ${PROJECT_VERSION})" "libopenimageio-dev" "openimageio-tools" "libopencolorio-dev" "libhwy-dev" "liblcms2-dev" "libpugixml-dev" "libzstd-dev")
pimg_debian_package(tools pimg-tools graphics "progressive images for OpenImageIO: command line"
    "pimgtool tone-maps, smooths, segments and paints pictures of every format that\nOpenImageIO reads, and pimgview shows them while you turn the settings. The\npackage also tells desktops what .pimg files are and makes thumbnails of them.")
pimg_debian_package(plugin openimageio-plugin-pimg graphics "progressive images for OpenImageIO: file format plugin"
    "Lets every program that uses OpenImageIO ${PIMG_OIIO_MINOR} read and write .pimg files.\nDebian's OpenImageIO has no folder for plugins of its own:\n/etc/profile.d/pimg.sh names ours in OIIO_LIBRARY_PATH at the next login.")
if(TARGET pimg_python)
    pimg_debian_package(python python3-pimg python "progressive images for OpenImageIO: Python 3 module"
        "Filters on NumPy arrays and on ImageBufs of Python's OpenImageIO."
        "python3 (>= ${PIMG_PYTHON_VERSION})" "python3 (<< ${PIMG_PYTHON_NEXT})" "python3-numpy")
    set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-openimageio")
endif()
if(TARGET pimg_gegl)
    pimg_debian_package(gegl gegl-plugin-pimg graphics "progressive images for OpenImageIO: operations for GEGL"
        "GEGL, and programs that use it such as GIMP, find these operations by\nthemselves.")
endif()
set(CPACK_DEBIAN_TOOLS_PACKAGE_RECOMMENDS "openimageio-plugin-pimg, openimageio-tools")
set(CPACK_DEBIAN_TOOLS_PACKAGE_SUGGESTS "python3-pimg")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME pimg)
set(CPACK_PACKAGE_VENDOR "The pimg authors")
set(CPACK_PACKAGE_CONTACT "The pimg authors <pimg@example.org>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL ${packages})
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SOURCE pimg)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_PLUGIN_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/packaging/conffiles")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/packaging/triggers")
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/packaging/prerm")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
include(CPack)
