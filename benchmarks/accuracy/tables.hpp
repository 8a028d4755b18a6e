// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cases.hpp"

#include <vector>

namespace tofmap::accuracy {

/// Prints Markdown tables with the scores of every method for each case.
void print_method_tables(const std::vector<Case>& cases);

/// Prints a table of wrong wraps of `joint` without each of its parts.
void print_ablation_table(const std::vector<Case>& cases);

/// Prints tables of wrong wraps and convergence for each departure of `jump` from the paper.
void print_departure_tables(const std::vector<Case>& cases);

}  // namespace tofmap::accuracy
