# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
include(CMakePackageConfigHelpers)

# The libraries that each module links, for tofmapConfig.cmake, so that a component searches only
# for what it needs. Consumers of shared libraries do not need the privately linked ones.
set(links_of_consumers LINK_LIBRARIES)
if(BUILD_SHARED_LIBS)
  set(links_of_consumers INTERFACE_LINK_LIBRARIES)
endif()
get_property(TOFMAP_MODULES GLOBAL PROPERTY TOFMAP_MODULES)
foreach(module IN LISTS TOFMAP_MODULES)
  get_target_property(links tofmap_${module} ${links_of_consumers})
  list(JOIN links " " links)
  string(APPEND TOFMAP_MODULE_LINKS "set(_tofmap_${module}_links ${links})\n")
endforeach()
list(JOIN TOFMAP_MODULES " " TOFMAP_MODULES)

set(TOFMAP_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/tofmap)
configure_package_config_file(cmake/tofmapConfig.cmake.in tofmapConfig.cmake
  INSTALL_DESTINATION ${TOFMAP_CMAKE_DIR})
write_basic_package_version_file(tofmapConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/tofmapConfig.cmake ${PROJECT_BINARY_DIR}/tofmapConfigVersion.cmake
  DESTINATION ${TOFMAP_CMAKE_DIR} COMPONENT development)
install(EXPORT tofmapTargets NAMESPACE tofmap:: DESTINATION ${TOFMAP_CMAKE_DIR} COMPONENT development)
install(DIRECTORY ${TOFMAP_OPENNI2_DIR}/ DESTINATION ${TOFMAP_OPENNI2_INSTALL_DIR}
  COMPONENT openni2_folder USE_SOURCE_PERMISSIONS PATTERN libTofmap.so.0 EXCLUDE)
install(DIRECTORY configs DESTINATION ${CMAKE_INSTALL_DATADIR}/tofmap COMPONENT program)
install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development)
