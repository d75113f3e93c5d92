# SPDX-License-Identifier: BSD-3-Clause
# The CMake package `pimg`, the pkg-config modules `pimg` and, for C, `pimg-c`.
include(CMakePackageConfigHelpers)

configure_package_config_file(cmake/pimgConfig.cmake.in pimgConfig.cmake
    INSTALL_DESTINATION ${PIMG_INSTALL_CMAKEDIR} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/pimgConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES
    ${PROJECT_BINARY_DIR}/pimgConfig.cmake
    ${PROJECT_BINARY_DIR}/pimgConfigVersion.cmake
    cmake/pimgDependencies.cmake
    DESTINATION ${PIMG_INSTALL_CMAKEDIR} COMPONENT dev)

# Relative to the .pc file, so that the installed tree can be moved.
if(IS_ABSOLUTE "${CMAKE_INSTALL_INCLUDEDIR}")
    set(PIMG_PC_INCLUDEDIR "${CMAKE_INSTALL_INCLUDEDIR}")
else()
    file(RELATIVE_PATH PIMG_PC_INCLUDEDIR
        "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" "${CMAKE_INSTALL_FULL_INCLUDEDIR}")
    string(PREPEND PIMG_PC_INCLUDEDIR "\${pcfiledir}/")
endif()
# What no header names is private to shared libraries. Who links static ones needs it, with --static or without.
set(PIMG_PC_REQUIRES "")
set(PIMG_PC_REQUIRES_PRIVATE "OpenColorIO >= 2.1, lcms2, libzstd, pugixml")
if(NOT BUILD_SHARED_LIBS)
    set(PIMG_PC_REQUIRES ", ${PIMG_PC_REQUIRES_PRIVATE}")
    set(PIMG_PC_REQUIRES_PRIVATE "")
endif()
foreach(module pimg pimg-c)
    configure_file(cmake/${module}.pc.in ${module}.pc @ONLY)
    install(FILES ${PROJECT_BINARY_DIR}/${module}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)
endforeach()
if(NOT PIMG_PACKAGING)
    install(FILES LICENSE THIRD-PARTY.md README.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT dev)
endif()
include(pimgSbom)

# What files of ours are, for file(1) and for desktops.
install(FILES codec/share/pimg-mime.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages RENAME pimg.xml
        COMPONENT tools)
install(FILES codec/share/pimg.magic DESTINATION ${CMAKE_INSTALL_DATADIR}/pimg COMPONENT tools)

# Packages only, for they name folders: thumbnails for file managers, and where the plugin is.
set(PIMG_PLUGIN_FULL_DIR "${PIMG_INSTALL_PLUGINDIR}")
if(NOT IS_ABSOLUTE "${PIMG_PLUGIN_FULL_DIR}")
    string(PREPEND PIMG_PLUGIN_FULL_DIR "${CMAKE_INSTALL_PREFIX}/")
endif()

if(PIMG_PACKAGING)
    configure_file(packaging/pimg-thumbnailer.in pimg-thumbnailer @ONLY)
    install(PROGRAMS ${PROJECT_BINARY_DIR}/pimg-thumbnailer DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tools)
    install(FILES packaging/pimg.thumbnailer DESTINATION ${CMAKE_INSTALL_DATADIR}/thumbnailers COMPONENT tools)
    configure_file(packaging/pimg.sh.in pimg.sh @ONLY)
    install(FILES ${PROJECT_BINARY_DIR}/pimg.sh DESTINATION /etc/profile.d COMPONENT plugin)
    include(pimgPackage)
endif()
