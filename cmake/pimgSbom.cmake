# SPDX-License-Identifier: BSD-3-Clause
# A software bill of materials (SPDX 2.3, JSON) of what this build links, with the versions that were found: installed as
# share/pimg/pimg.spdx.json. THIRD-PARTY.md says how each is linked.
include_guard(GLOBAL)

set(PIMG_SBOM_PACKAGES "")
set(PIMG_SBOM_RELATIONS "")
function(pimg_sbom_package name version licence home)
    string(REGEX REPLACE "[^A-Za-z0-9]" "-" id "${name}")
    if(NOT version)
        set(version NOASSERTION)
    endif()
    set(PIMG_SBOM_PACKAGES "${PIMG_SBOM_PACKAGES},
    {
      \"SPDXID\": \"SPDXRef-${id}\", \"name\": \"${name}\", \"versionInfo\": \"${version}\",
      \"downloadLocation\": \"${home}\", \"filesAnalyzed\": false,
      \"licenseConcluded\": \"${licence}\", \"licenseDeclared\": \"${licence}\", \"copyrightText\": \"NOASSERTION\"
    }" PARENT_SCOPE)
    set(PIMG_SBOM_RELATIONS "${PIMG_SBOM_RELATIONS},
    {
      \"spdxElementId\": \"SPDXRef-pimg\", \"relationshipType\": \"DEPENDS_ON\",
      \"relatedSpdxElement\": \"SPDXRef-${id}\"
    }" PARENT_SCOPE)
endfunction()

pimg_sbom_package(OpenImageIO "${OpenImageIO_VERSION}" Apache-2.0
    https://github.com/AcademySoftwareFoundation/OpenImageIO)
pimg_sbom_package(OpenColorIO "${OpenColorIO_VERSION}" BSD-3-Clause
    https://github.com/AcademySoftwareFoundation/OpenColorIO)
pimg_sbom_package(Imath "${Imath_VERSION}" BSD-3-Clause https://github.com/AcademySoftwareFoundation/Imath)
pimg_sbom_package(highway "${hwy_VERSION}" Apache-2.0 https://github.com/google/highway)
pimg_sbom_package(lcms2 "${PIMG_LCMS_VERSION}" MIT https://www.littlecms.com)
pimg_sbom_package(pugixml "${pugixml_VERSION}" MIT https://pugixml.org)
pimg_sbom_package(zstd "${PIMG_ZSTD_VERSION}" BSD-3-Clause https://github.com/facebook/zstd)
if(TARGET pimgview)
    pimg_sbom_package(glfw "${PIMG_GLFW_VERSION}" Zlib https://www.glfw.org)
    pimg_sbom_package(imgui "${PIMG_IMGUI_VERSION}" MIT https://github.com/ocornut/imgui)
endif()
if(TARGET pimg_tool OR TARGET pimg_ofx)
    pimg_sbom_package(boost "" BSL-1.0 https://www.boost.org)
endif()
if(TARGET pimg_python)
    pimg_sbom_package(pybind11 "${pybind11_VERSION}" BSD-3-Clause https://github.com/pybind/pybind11)
endif()
if(TARGET pimg_gegl)
    pimg_sbom_package(gegl "${PIMG_GEGL_VERSION}" LGPL-3.0-or-later https://gegl.org)
endif()

# The date of the sources, not of the build, so that two builds give the same file.
if(DEFINED ENV{SOURCE_DATE_EPOCH})
    string(TIMESTAMP PIMG_SBOM_DATE "%Y-%m-%dT%H:%M:%SZ" UTC)
else()
    set(PIMG_SBOM_DATE "2026-11-26T00:00:00Z")
endif()
configure_file("${PROJECT_SOURCE_DIR}/cmake/pimg.spdx.json.in" "${PROJECT_BINARY_DIR}/pimg.spdx.json" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/pimg.spdx.json" DESTINATION ${CMAKE_INSTALL_DATADIR}/pimg COMPONENT dev)
