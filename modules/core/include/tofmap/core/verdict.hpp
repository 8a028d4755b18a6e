// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace tofmap {

/// How far a result can be trusted, from best to worst.
enum class Verdict { good, check, bad };

/// "good", "check" or "bad".
std::string_view name_of(Verdict verdict);

/// The verdict as a sentence for users, such as "Looks right."
std::string_view sentence_of(Verdict verdict);

}  // namespace tofmap
