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
    DESTINATION ${PIMG_INSTALL_CMAKEDIR})

# Relative to the .pc file, so that the installed tree can be moved.
if(IS_ABSOLUTE "${CMAKE_INSTALL_INCLUDEDIR}")
    set(PIMG_PC_INCLUDEDIR "${CMAKE_INSTALL_INCLUDEDIR}")
else()
    file(RELATIVE_PATH PIMG_PC_INCLUDEDIR
        "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" "${CMAKE_INSTALL_FULL_INCLUDEDIR}")
    string(PREPEND PIMG_PC_INCLUDEDIR "\${pcfiledir}/")
endif()
foreach(module pimg pimg-c)
    configure_file(cmake/${module}.pc.in ${module}.pc @ONLY)
    install(FILES ${PROJECT_BINARY_DIR}/${module}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endforeach()
install(FILES LICENSE README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

# What files of ours are, for file(1) and for desktops.
install(FILES codec/share/pimg-mime.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages RENAME pimg.xml)
install(FILES codec/share/pimg.magic DESTINATION ${CMAKE_INSTALL_DATADIR}/pimg)
