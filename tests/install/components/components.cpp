// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Links the wanted components, and calls one.

#include <tofmap/filters/filter_chain.hpp>

int main() { return tofmap::smoothing_chain().empty() ? 1 : 0; }
