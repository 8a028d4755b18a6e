// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Compiles a function three times: for AVX-512, for AVX2, and portably. The loader selects the
/// best version that the processor supports. Functions that the marked function calls must be
/// inlined into it.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define TOFMAP_VECTOR_CLONES [[gnu::target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")]]
#else
#define TOFMAP_VECTOR_CLONES
#endif
