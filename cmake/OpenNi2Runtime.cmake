# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause

# OpenNI2 loads only the drivers in the folder OpenNI2/Drivers beside its own library. This file
# therefore makes a folder with links to the system's library and drivers, to which the project's
# driver is added. Programs that load the library from there find all drivers, without root rights.
set(TOFMAP_OPENNI2_DIR ${PROJECT_BINARY_DIR}/openni2)
set(TOFMAP_OPENNI2_INSTALL_NAME tofmap)
set(TOFMAP_OPENNI2_INSTALL_DIR ${CMAKE_INSTALL_LIBDIR}/${TOFMAP_OPENNI2_INSTALL_NAME})

find_package(PkgConfig REQUIRED)
pkg_check_modules(OpenNI2 REQUIRED IMPORTED_TARGET libopenni2)
list(GET OpenNI2_LINK_LIBRARIES 0 openni2_library)
get_filename_component(openni2_libdir ${openni2_library} DIRECTORY)
file(GLOB openni2_drivers ${openni2_libdir}/OpenNI2/Drivers/lib*.so.0)
list(FILTER openni2_drivers EXCLUDE REGEX "/libTofmap[.]so[.]0$")  # from an installed package
file(MAKE_DIRECTORY ${TOFMAP_OPENNI2_DIR}/OpenNI2/Drivers)
file(CREATE_LINK ${openni2_libdir}/libOpenNI2.so.0 ${TOFMAP_OPENNI2_DIR}/libOpenNI2.so.0 SYMBOLIC)
foreach(driver IN LISTS openni2_drivers)
  get_filename_component(name ${driver} NAME)
  file(CREATE_LINK ${driver} ${TOFMAP_OPENNI2_DIR}/OpenNI2/Drivers/${name} SYMBOLIC)
endforeach()

# tofmap_use_openni2_runtime(TARGET): sets the RPATH of a target, in the build and when installed,
# so that it loads OpenNI2 and the project's driver from that folder, and the project's shared
# libraries.
function(tofmap_use_openni2_runtime target)
  add_dependencies(${target} tofmap_openni2_driver)
  set_property(TARGET ${target} APPEND PROPERTY BUILD_RPATH ${TOFMAP_OPENNI2_DIR})
  set_property(TARGET ${target} APPEND PROPERTY
    INSTALL_RPATH $ORIGIN/../${TOFMAP_OPENNI2_INSTALL_DIR} $ORIGIN/../${CMAKE_INSTALL_LIBDIR})
endfunction()
