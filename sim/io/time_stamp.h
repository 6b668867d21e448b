#pragma once

#include <optional>
#include <string_view>

namespace continuum {

/// Seconds since 1970-01-01 of a date with a time of day as ISO 8601 writes it
/// ("2024-05-01T12:00:00.010Z", "2024-05-01 12:00:00,01+02:00"; without a zone: UTC), or since
/// midnight of a time of day alone ("12:00:00.01"). Nothing for any other text. Exact to the
/// nanosecond.
std::optional<long double> SecondsOfStamp(std::string_view text);

}  // namespace continuum
