#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sim/page/plot_spec.h"

namespace continuum::page {

/// The rows to draw, ascending: all of them up to `limit`, otherwise the first, the last and, in
/// equal stretches of rows, those with the lowest and highest value and one gap of every series.
std::vector<std::size_t> Decimate(const std::vector<Series>& series, std::size_t rows,
                                  std::size_t limit);

/// The panel's data as JSON that is safe inside a script element. Values carry six significant
/// digits of their series' span, so that a small ripple on a large offset survives.
std::string SeriesJson(const TimeSeriesSpec& spec, const std::vector<std::size_t>& rows, int group);

}  // namespace continuum::page
