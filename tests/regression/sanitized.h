#pragma once

/// Whether the tests run under AddressSanitizer, at -O1: about 30 times slower, so the longest of them take
/// fewer steps there. What they assert is the same.
namespace touchstone::testing {

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace touchstone::testing
