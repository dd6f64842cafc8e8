#pragma once

#include <catch2/catch.hpp>

/// For tests of what the runtime of a sanitizer takes for itself: limits of memory and descriptors,
/// libraries for programs that are built without it.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SKIP_UNDER_SANITIZER()                                          \
  do {                                                                  \
    WARN("SKIPPED: the runtime of a sanitizer does not bear the test"); \
    return;                                                             \
  } while (false)
#else
#define SKIP_UNDER_SANITIZER() static_cast<void>(0)
#endif
