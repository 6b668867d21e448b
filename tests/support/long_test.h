#pragma once

#include <cstdlib>

#include <gtest/gtest.h>

namespace continuum::testing {

/// Whether long tests run too: `scripts/test long` sets CONTINUUM_LONG.
inline bool IsLongRun() { return std::getenv("CONTINUUM_LONG") != nullptr; }

inline constexpr bool kIsSanitized =
#if defined(__SANITIZE_ADDRESS__)
    true;
#elif defined(__has_feature)
    __has_feature(address_sanitizer);
#else
    false;
#endif

}  // namespace continuum::testing

/// First line of a test that is left to `scripts/test long`: `reason` says what stands for it.
#define CONTINUUM_LONG(reason) CONTINUUM_LONG_IF(true, reason)

/// The same of one that sanitizers slow down to minutes; without them it always runs.
#define CONTINUUM_LONG_IF_SANITIZED(reason) \
  CONTINUUM_LONG_IF(::continuum::testing::kIsSanitized, reason)

#define CONTINUUM_LONG_IF(condition, reason)             \
  if ((condition) && !::continuum::testing::IsLongRun()) \
  GTEST_SKIP() << "left to scripts/test "                \
                  "long: " reason
