// SPDX-License-Identifier: MIT
#pragma once

namespace sketchsplat::test {

/// Whether this is built under a sanitizer, which takes terabytes of addresses and ten times the
/// time: limits of both are not for it.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#elif defined(__has_feature)
constexpr bool kSanitized = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
constexpr bool kSanitized = false;
#endif

}  // namespace sketchsplat::test
