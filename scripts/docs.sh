#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs what is missing and writes the pages of docs/ and the reference of the public headers as
# a site: BUILD_DIR/docs/html/index.html (BUILD_DIR: default build-docs). Any warning of Doxygen is
# an error.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bash scripts/packages.sh --tests
build=${BUILD_DIR:-build-docs}

cmake -S . -B "$build" -G Ninja -DTOFMAP_BUILD_TESTS=OFF -DTOFMAP_BUILD_DOCS=ON >/dev/null
cmake --build "$build" --target docs
echo "the site: $build/docs/html/index.html"
