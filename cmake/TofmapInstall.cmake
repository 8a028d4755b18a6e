# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
include(CMakePackageConfigHelpers)

set(TOFMAP_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/tofmap)
configure_package_config_file(cmake/tofmapConfig.cmake.in tofmapConfig.cmake
  INSTALL_DESTINATION ${TOFMAP_CMAKE_DIR})
write_basic_package_version_file(tofmapConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/tofmapConfig.cmake ${PROJECT_BINARY_DIR}/tofmapConfigVersion.cmake
  DESTINATION ${TOFMAP_CMAKE_DIR})
install(EXPORT tofmapTargets NAMESPACE tofmap:: DESTINATION ${TOFMAP_CMAKE_DIR})
install(DIRECTORY configs DESTINATION ${CMAKE_INSTALL_DATADIR}/tofmap)
install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
