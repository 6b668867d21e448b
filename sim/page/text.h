#pragma once

#include <string>
#include <string_view>

#include "sim/page/plot_spec.h"

namespace continuum::page {

/// The text with U+FFFD for bytes that are not UTF-8 and for control characters.
std::string ValidUtf8(std::string_view text);

/// Text for HTML content and quoted attributes, as ValidUtf8.
std::string Escape(std::string_view text);

/// Escaped text in which **bold** and `code` are marked up; unpaired marks stay as they are.
std::string Inline(std::string_view text);

/// Number of characters (not bytes) of an UTF-8 text.
std::size_t Length(std::string_view text);

/// The first `length` characters, the last one an ellipsis when something is cut off.
std::string Shorten(std::string_view text, std::size_t length);

/// "label [unit]", not escaped.
std::string AxisTitle(const Axis& axis);

/// Six significant digits at most, for JSON and SVG attributes.
std::string Compact(double value, int digits = 6);

/// A number to read, with a true minus sign.
std::string Readable(double value, int digits = 3);

/// CSS class and colour variable of a style; `index` picks the palette's colour for kAuto.
std::string StyleName(Style style, std::size_t index);

/// What stands in place of a plot that has nothing to show.
std::string NothingToPlot();

/// One entry of a legend; kind "line", "dot" or "band". With `value`, a place for the hovered
/// value.
std::string LegendKey(const std::string& name, const std::string& style, const std::string& kind,
                      bool value);

/// Frame shared by all plots: title, legend, axis titles around `plot`.
std::string Figure(const std::string& classes, const std::string& title, const std::string& legend,
                   const std::string& y_title, const std::string& plot, const std::string& x_title,
                   const std::string& note = "");

}  // namespace continuum::page
