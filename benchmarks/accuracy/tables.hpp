// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cases.hpp"

#include <vector>

namespace tofmap::accuracy {

/// Prints every method against `cases`, in Markdown.
void print_method_tables(const std::vector<Case>& cases);

/// Prints what is left of `joint` without each of its parts.
void print_ablation_table(const std::vector<Case>& cases);

/// Prints what sets `jump` apart from the paper, one departure at a time.
void print_departure_tables(const std::vector<Case>& cases);

}  // namespace tofmap::accuracy
