# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause

# Sets the compiler flags of a target of the project. They are private, except those that a
# sanitizer or coverage needs in all targets.
function(tofmap_private_flags target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual)
  # GCC 12 wrongly warns of overlaps in std::string (GCC bug 105651).
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(${target} PRIVATE -Wno-restrict)
    # With precompiled headers, it takes code of the standard library for code of the project.
    if(TOFMAP_PRECOMPILE_HEADERS)
      target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-stringop-overflow
                                               -Wno-stringop-overread)
    endif()
  endif()
  # Clang does not know `#pragma GCC ivdep`, which is for speed alone.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    target_compile_options(${target} PRIVATE -Wno-unknown-pragmas)
  endif()
  # Files that are compiled together (unity builds) see the names of each other's anonymous
  # namespaces. GCC takes such files for headers, and warns of members whose types are in an
  # anonymous namespace.
  if(CMAKE_UNITY_BUILD)
    target_compile_options(${target} PRIVATE -Wno-shadow)
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
    endif()
  endif()
  if(TOFMAP_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(TOFMAP_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${TOFMAP_SANITIZE} -fno-omit-frame-pointer
                                             -fno-sanitize-recover=all)
    # GCC wrongly warns of uninitialized variables in instrumented code.
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      target_compile_options(${target} PRIVATE -Wno-maybe-uninitialized)
    endif()
    # Vectorised loops convert NaN to whole numbers and discard the results. GCC does not check it.
    if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND TOFMAP_SANITIZE MATCHES "undefined")
      target_compile_options(${target} PRIVATE -fno-sanitize=float-cast-overflow)
    endif()
    target_link_options(${target} PUBLIC -fsanitize=${TOFMAP_SANITIZE})
    # With a sanitizer, Eigen would align memory itself, but Debian's PCL was built to use the
    # alignment of malloc. Both must use the same, and so must all consumers.
    target_compile_definitions(${target} PUBLIC EIGEN_MALLOC_ALREADY_ALIGNED=1)
  endif()
  if(TOFMAP_COVERAGE)
    # Lines that several threads run are counted correctly only with atomic counters.
    target_compile_options(${target} PRIVATE --coverage -fprofile-update=atomic)
    target_link_options(${target} PUBLIC --coverage)
  endif()
endfunction()

# tofmap_precompile(TARGET [HEADERS <header> …]): precompiles these headers for a target, and those
# that nearly all files include directly or indirectly.
# tofmap_precompile(TARGET LIKE OTHER): uses what was precompiled for another target, which takes no
# time. Both must have the same flags for position-independent code, optimisation and OpenMP.
# Does nothing unless TOFMAP_PRECOMPILE_HEADERS is set.
function(tofmap_precompile target)
  cmake_parse_arguments(PRECOMPILE "" "LIKE" "HEADERS" ${ARGN})
  if(NOT TOFMAP_PRECOMPILE_HEADERS)
    return()
  endif()
  if(PRECOMPILE_LIKE)
    target_precompile_headers(${target} REUSE_FROM ${PRECOMPILE_LIKE})
  else()
    # With a time in them, Clang's would never be found in a compiler cache.
    if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
      target_compile_options(${target} PRIVATE "SHELL:-Xclang -fno-pch-timestamp")
    endif()
    target_precompile_headers(${target} PRIVATE <algorithm> <filesystem> <functional> <string>
      <vector> <Eigen/Geometry> ${PRECOMPILE_HEADERS})
  endif()
endfunction()

# Headers of PCL that take a second or two to compile in each file. None may depend on
# PCL_NO_PRECOMPILE, which sources define after them.
set(tofmap_pcl_headers <pcl/point_cloud.h> <pcl/point_types.h>)

# tofmap_add_module(NAME SOURCES a.cpp … [PUBLIC lib …] [PRIVATE lib …])
#
# Defines the library tofmap_<NAME>, alias tofmap::<NAME>, from modules/<NAME>/src, with the public
# headers of modules/<NAME>/include, and registers both for installation.
function(tofmap_add_module name)
  cmake_parse_arguments(MODULE "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  list(TRANSFORM MODULE_SOURCES PREPEND src/ REGEX "^[^/]")
  add_library(tofmap_${name} ${MODULE_SOURCES})
  add_library(tofmap::${name} ALIAS tofmap_${name})
  set_property(GLOBAL APPEND PROPERTY TOFMAP_MODULES ${name})
  set_target_properties(tofmap_${name} PROPERTIES EXPORT_NAME ${name}
    POSITION_INDEPENDENT_CODE ON DEFINE_SYMBOL "" INSTALL_RPATH $ORIGIN
    VERSION ${PROJECT_VERSION} SOVERSION ${TOFMAP_ABI_VERSION})
  target_include_directories(tofmap_${name}
    PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
           $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE src)
  target_link_libraries(tofmap_${name} PUBLIC ${MODULE_PUBLIC} PRIVATE ${MODULE_PRIVATE})
  tofmap_private_flags(tofmap_${name})
  install(TARGETS tofmap_${name} EXPORT tofmapTargets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development)
  install(DIRECTORY include/tofmap DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
endfunction()

# tofmap_vectorize(FILE …): lets GCC vectorize the loops of source files, by switching off errno and
# traps of floating-point functions. These files do not use the precompiled headers, which need
# equal flags. -Wno-psabi: vector arguments are passed only to inlined functions, so their ABI is
# irrelevant.
function(tofmap_vectorize)
  set_source_files_properties(${ARGN} PROPERTIES
    COMPILE_OPTIONS "-fno-math-errno;-fno-trapping-math;-Wno-psabi" SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# tofmap_use_pcl(TARGET): adds the include folders of PCL, as system headers, and the libraries that
# the project uses, without PCL's directory-wide flags.
function(tofmap_use_pcl target)
  target_include_directories(${target} SYSTEM PUBLIC ${PCL_INCLUDE_DIRS})
  target_link_libraries(${target} PUBLIC pcl_common pcl_io pcl_kdtree pcl_search)
endfunction()

# tofmap_write_module_links(FILE): writes a line per module, and one for the program, with its name
# and the libraries that it links. A test compares docs/architecture.md with this file.
function(tofmap_write_module_links file)
  get_property(modules GLOBAL PROPERTY TOFMAP_MODULES)
  set(text)
  foreach(module IN LISTS modules ITEMS openni2_driver)
    get_target_property(links tofmap_${module} LINK_LIBRARIES)
    list(JOIN links " " links)
    string(APPEND text "${module} ${links}\n")
  endforeach()
  if(TARGET tofmap_commands)
    get_target_property(links tofmap_commands LINK_LIBRARIES)
    list(JOIN links " " links)
    string(APPEND text "apps ${links}\n")
  endif()
  file(WRITE ${file} "${text}")
endfunction()
