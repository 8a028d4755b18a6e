# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause

# The target `docs`: pages of docs/ and the reference of the public headers, in docs/html of the
# build folder. A warning of Doxygen fails it.
find_package(Doxygen 1.9 REQUIRED)
set(TOFMAP_DOCS_OUTPUT ${PROJECT_BINARY_DIR}/docs)
file(GLOB includes ${PROJECT_SOURCE_DIR}/modules/*/include)
list(JOIN includes " " TOFMAP_DOCS_INCLUDES)
configure_file(docs/Doxyfile.in ${PROJECT_BINARY_DIR}/Doxyfile @ONLY)
file(MAKE_DIRECTORY ${TOFMAP_DOCS_OUTPUT})
add_custom_target(docs
  COMMAND Doxygen::doxygen ${PROJECT_BINARY_DIR}/Doxyfile
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
  COMMENT "Writing the reference to ${TOFMAP_DOCS_OUTPUT}/html"
  VERBATIM)
