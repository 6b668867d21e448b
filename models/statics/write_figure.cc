#include "models/statics/write_figure.h"

#include <fmt/format.h>

#include "models/statics/figure_layout.h"
#include "models/statics/legend.h"
#include "models/statics/panel_drawing.h"
#include "models/statics/results.h"
#include "sim/io/file.h"

namespace continuum::statics {
namespace {

std::string Description(const Figure& figure) {
  if (Many(figure)) return fmt::format("{} cases", figure.shapes.size());
  std::string text;
  for (const Shape& shape : figure.shapes) text += (text.empty() ? "" : "; ") + shape.label;
  return text;
}

}  // namespace

void RequireFigureEnding(const std::filesystem::path& path) {
  RequireExtension(path, {".png", ".svg", ".pdf"}, "--plot");
}

PagePoint FigureSize(const Figure& figure) { return LayoutOf(figure).size; }

void DrawFigure(const Figure& figure, Canvas& canvas) {
  const Layout layout = LayoutOf(figure);
  canvas.Text({layout.panels[0].corner.x(), 16}, figure.title, {}, {9, true});
  for (std::size_t i = 0; i < layout.panels.size(); ++i) {
    const std::string letter = std::string("(") + static_cast<char>('a' + i) + ")";
    DrawPanel(figure, layout, layout.panels[i], letter, canvas);
  }
  if (!figure.shapes.empty()) DrawLegend(figure, layout, canvas);
}

void WriteFigure(const std::filesystem::path& path, const Figure& figure) {
  RequireFigureEnding(path);
  const Figure drawn = ColouredByOrderWhereLoadsAreAlike(figure);
  const PageNames names{drawn.title, Description(drawn)};
  WriteFile(path, Render(path.extension().string(), FigureSize(drawn), names,
                         [&](Canvas& canvas) { DrawFigure(drawn, canvas); }));
}

}  // namespace continuum::statics
