#pragma once

#include <cstdlib>

#include <gtest/gtest.h>

namespace continuum::testing {

/// Whether a test that the sanitizers slow down to minutes is left to `scripts/test long`, which
/// sets CONTINUUM_LONG. Without sanitizers every test runs.
inline bool IsLeftToLongRun() {
#if defined(__SANITIZE_ADDRESS__)
  constexpr bool kSanitized = true;
#elif defined(__has_feature)
  constexpr bool kSanitized = __has_feature(address_sanitizer);
#else
  constexpr bool kSanitized = false;
#endif
  return kSanitized && std::getenv("CONTINUUM_LONG") == nullptr;
}

}  // namespace continuum::testing

/// First line of a test that the sanitizers slow down to minutes: `reason` says by what.
#define CONTINUUM_LONG_IF_SANITIZED(reason)    \
  if (::continuum::testing::IsLeftToLongRun()) \
  GTEST_SKIP() << "left to scripts/test "      \
                  "long: " reason
