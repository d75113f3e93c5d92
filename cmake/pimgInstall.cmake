# SPDX-License-Identifier: BSD-3-Clause
# The CMake package `pimg` and the pkg-config module `pimg`.
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
configure_file(cmake/pimg.pc.in pimg.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/pimg.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(FILES LICENSE README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
