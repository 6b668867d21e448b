#pragma once

#include <filesystem>

#include "models/statics/canvas.h"
#include "models/statics/figure.h"

namespace continuum::statics {

/// @throws Error unless the path ends in .png, .svg or .pdf: called before the work.
void RequireFigureEnding(const std::filesystem::path& path);

/// Draws the shapes in two views at one scale, gravity downwards: cases whose gravity points along
/// different base axes have a row of views each. Format by the ending of the path; the whole file
/// or nothing. @throws Error for another ending.
void WriteFigure(const std::filesystem::path& path, const Figure& figure);

/// Size of the page [pt] and its drawing.
PagePoint FigureSize(const Figure& figure);
void DrawFigure(const Figure& figure, Canvas& canvas);

}  // namespace continuum::statics
