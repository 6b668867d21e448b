#pragma once

// Vectors of four numbers where the machine has them. AVX2 alone has no fused multiply-add, so that
// results are the same on every machine. Sanitizers run before what chooses is ready.
// Older clangs do not link such functions.
#if defined(__x86_64__) && defined(__linux__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define CONTINUUM_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define CONTINUUM_WIDE
#endif

namespace continuum {

/// Four numbers at once, at any address of a double.
using Four = double __attribute__((vector_size(32), aligned(8), may_alias));
inline const Four& FourAt(const double* x) { return *reinterpret_cast<const Four*>(x); }
inline Four& FourAt(double* x) { return *reinterpret_cast<Four*>(x); }

}  // namespace continuum
