# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Makes a Debian package of each install component: `cmake --build BUILD --target package`. CPack
# determines the packages that the libraries and the program depend on.
set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL library development program)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_COMPONENT_DEVELOPMENT_DEPENDS library)
set(CPACK_COMPONENT_PROGRAM_DEPENDS library)
set(CPACK_PACKAGE_CONTACT "the tofmap authors")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY "=")
get_property(modules GLOBAL PROPERTY TOFMAP_MODULES)
foreach(module IN LISTS modules)
  list(APPEND CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/modules/${module})
endforeach()

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libtofmap${TOFMAP_ABI_VERSION})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION 
"Libraries that unwrap the phase of dual-frequency time-of-flight cameras,
filter and register range images, and map rooms larger than such cameras can
see unambiguously.")

# The public headers of core, unwrap and filters need only Eigen. Those of cloud, and of the modules
# that use it, include PCL's.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libtofmap-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS libeigen3-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "libpcl-dev")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION 
"Headers, CMake files and examples of the libraries. tofmap::unwrap and
tofmap::filters need only Eigen; modules for clouds and maps also need the
recommended packages.")

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME tofmap)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
# Drawing without a display needs EGL and Mesa's drivers, which are loaded at run time.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "libegl1, libgl1-mesa-dri")
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION 
"A program that records, unwraps, maps, evaluates and shows frames of
dual-frequency time-of-flight cameras, and an OpenNI2 driver that simulates
such a camera.")

# Each package has a copyright file as Debian requires, with the licence of three.js, which is part
# of reports.
file(READ LICENSE licence)
file(READ modules/visualization/src/page/three_notice.txt three_licence)
file(WRITE ${PROJECT_BINARY_DIR}/copyright "${licence}\nReports carry three.js:\n\n${three_licence}")
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} upper)
  install(FILES ${PROJECT_BINARY_DIR}/copyright COMPONENT ${component} EXCLUDE_FROM_ALL
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
endforeach()
include(CPack)
