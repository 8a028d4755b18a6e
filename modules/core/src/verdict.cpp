// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/core/verdict.hpp"

namespace tofmap {

std::string_view name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::good:
      return "good";
    case Verdict::check:
      return "check";
    case Verdict::bad:
      break;
  }
  return "bad";
}

std::string_view sentence_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::good:
      return "Looks right.";
    case Verdict::check:
      return "Check this result.";
    case Verdict::bad:
      break;
  }
  return "Do not trust this result.";
}

}  // namespace tofmap
