# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause

# What nearly every file reads, itself or by way of others.
set(tofmap_common_headers <algorithm> <filesystem> <functional> <string> <vector> <Eigen/Geometry>)

# Flags that every target of the project gets, privately: consumers inherit none but those that
# sanitizers and coverage need all to agree on.
function(tofmap_private_flags target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual)
  # GCC 12 sees overlaps in std::string that are not there (GCC bug 105651).
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(${target} PRIVATE -Wno-restrict)
  endif()
  if(TOFMAP_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(TOFMAP_SANITIZE)
    # Instrumented code looks uninitialized to GCC where it is not, in the standard library, too.
    target_compile_options(${target} PRIVATE -Wno-maybe-uninitialized -fsanitize=${TOFMAP_SANITIZE} -fno-omit-frame-pointer
                                             -fno-sanitize-recover=all)
    target_link_options(${target} PUBLIC -fsanitize=${TOFMAP_SANITIZE})
    # Under a sanitizer Eigen would align memory by hand and expect the same of what Debian's PCL
    # allocated, which relies on malloc as it is aligned anyway. Those who link to it must agree.
    target_compile_definitions(${target} PUBLIC EIGEN_MALLOC_ALREADY_ALIGNED=1)
  endif()
  if(TOFMAP_COVERAGE)
    # Lines run by several threads at once are counted right only if the counters are atomic.
    target_compile_options(${target} PRIVATE --coverage -fprofile-update=atomic)
    target_link_options(${target} PUBLIC --coverage)
  endif()
  if(TOFMAP_PRECOMPILE_HEADERS)
    target_precompile_headers(${target} PRIVATE ${tofmap_common_headers})
  endif()
endfunction()

# tofmap_add_module(NAME SOURCES a.cpp … [PUBLIC lib …] [PRIVATE lib …])
#
# Defines tofmap_<NAME>, alias tofmap::<NAME>, from modules/<NAME>/src, with the
# public headers of modules/<NAME>/include, and registers both for installation.
# Libraries of others are system headers: their warnings are not ours.
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

# Has the loops of files of this folder become vector instructions: no error flags of the C library,
# no traps. Headers precompiled otherwise do not fit these flags. Vectors are passed to functions
# that are inlined alone, so that it does not matter how a processor would pass them.
function(tofmap_vectorize)
  set_source_files_properties(${ARGN} PROPERTIES
    COMPILE_OPTIONS "-fno-math-errno;-fno-trapping-math;-Wno-psabi" SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# PCL without its directory-wide flags: a target that carries its include folders
# (as system headers) and the libraries of the components that the project uses.
function(tofmap_use_pcl target)
  target_include_directories(${target} SYSTEM PUBLIC ${PCL_INCLUDE_DIRS})
  target_link_libraries(${target} PUBLIC pcl_common pcl_io pcl_kdtree pcl_search)
endfunction()

# tofmap_write_module_links(FILE): a line a module, and one for the program: its name and what it
# links. A test compares docs/architecture.md with it.
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
