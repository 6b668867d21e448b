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

using Four = double __attribute__((vector_size(32)));

/// Four numbers at any address of a double. Only a packed member tells every compiler that nothing
/// is aligned there: clang forgets the alignment of a typedef where a reference is bound.
struct __attribute__((packed, may_alias)) FourAnywhere {
  Four v;
};
inline const FourAnywhere& FourAt(const double* x) {
  return *reinterpret_cast<const FourAnywhere*>(x);
}
inline FourAnywhere& FourAt(double* x) { return *reinterpret_cast<FourAnywhere*>(x); }

}  // namespace continuum
