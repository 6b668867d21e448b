#include "models/statics/figure_layout.h"

#include <cmath>
#include <filesystem>
#include <set>
#include <tuple>

#include <gmock/gmock.h>

#include "error.h"
#include "models/statics/canvas.h"
#include "models/statics/marks.h"
#include "models/statics/palette.h"
#include "models/statics/write_figure.h"
#include "sim/io/file.h"
#include "support/scratch.h"

namespace continuum::statics {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;
using ::testing::Not;

const Vector3d kDown(0, 0, -9.81), kLevel(-9.81, 0, 0);

Shape Arc(double bend, const std::string& label = "case") {
  Shape shape;
  shape.label = label;
  for (int i = 0; i <= 20; ++i) {
    const double s = 0.005 * i;
    shape.backbone.emplace_back(bend * s * s, 0, s);
    if (i % 5 == 0) shape.discs.push_back({shape.backbone.back(), Vector3d::UnitZ(), 0.008, 0.002});
  }
  shape.drives = {{shape.backbone, true}, {shape.backbone, false}};
  shape.diameter = 0.001;
  return shape;
}

Figure Figured(std::size_t count, const Vector3d& gravity = Vector3d::Zero()) {
  Figure figure;
  figure.title = "title <1>";
  figure.base_radius = 0.01;
  for (std::size_t i = 0; i < count; ++i) {
    figure.shapes.push_back(Arc(0.5 * static_cast<double>(i)));
    figure.shapes.back().gravity = gravity;
    figure.shapes.back().load = static_cast<double>(i);
  }
  return figure;
}

class FigureFile : public ::testing::Test {
 protected:
  std::string Written(const Figure& figure, const std::string& ending) {
    const std::filesystem::path file = scratch_.folder() / ("figure" + ending);
    WriteFigure(file, figure);
    return ReadFile(file);
  }

  testing::Scratch scratch_;
};

TEST_F(FigureFile, IsPngSvgOrPdfByItsEnding) {
  const Figure figure = Figured(3, kDown);
  const std::string png = Written(figure, ".png");
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(png.substr(12, 4), "IHDR");
  EXPECT_THAT(Written(figure, ".svg"), HasSubstr("<title>title &lt;1&gt;</title>"));
  EXPECT_THAT(Written(figure, ".svg"), HasSubstr("</svg>"));
  EXPECT_EQ(Written(figure, ".pdf").substr(0, 5), "%PDF-");
}

TEST_F(FigureFile, OfAnotherEndingIsRefusedWithTheThreeThatExist) {
  try {
    Written(Figured(1), ".jpg");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::kInput);
    for (const char* ending : {".png", ".svg", ".pdf", "figure.jpg"})
      EXPECT_THAT(error.what(), HasSubstr(ending));
  }
  EXPECT_FALSE(std::filesystem::exists(scratch_.folder() / "figure.jpg"));
}

TEST_F(FigureFile, RepeatsByteForByteAndHoldsNoDate) {
  const Figure figure = Figured(3, kDown);
  for (const char* ending : {".png", ".svg", ".pdf"})
    EXPECT_EQ(Written(figure, ending), Written(figure, ending)) << ending;
  EXPECT_THAT(Written(figure, ".pdf"), Not(HasSubstr("CreationDate")));
}

TEST_F(FigureFile, TakesLabelsThatAreNotUtf8) {
  Figure figure = Figured(1);
  figure.shapes[0].label = "F\xE4lle & <b>";
  EXPECT_THAT(Written(figure, ".svg"), HasSubstr("F\xEF\xBF\xBDlle &amp; &lt;b&gt;"));
  for (const char* ending : {".png", ".pdf"}) EXPECT_NO_THROW(Written(figure, ending)) << ending;
}

TEST_F(FigureFile, ShowsARobotWithoutAnySolvedCase) {
  for (const char* ending : {".png", ".svg", ".pdf"})
    EXPECT_NO_THROW(Written(Figured(0), ending)) << ending;
}

TEST(Figure, KeepsAllInkOnThePage) {
  for (const std::size_t count : {std::size_t{1}, kMostNamed, kMostNamed + 1, std::size_t{200}}) {
    Figure figure = Figured(count, kDown);
    figure.shapes[0].force = {3, 0, -2};
    figure.shapes[0].mount = {{0, 0, 0.1}, {0, 0, 0.11}};
    figure.shapes[0].measured = {{0.05, 0.01, 0.02}};
    figure.shapes[0].label = std::string(300, 'W');
    const Eigen::Vector4d ink = InkExtents([&](Canvas& c) { DrawFigure(figure, c); });
    const PagePoint size = FigureSize(figure);
    EXPECT_GE(ink.head<2>().minCoeff(), 0) << count;
    EXPECT_LE(ink[2], size.x()) << count;
    EXPECT_LE(ink[3], size.y()) << count;
    EXPECT_GT(ink[3], 0.8 * size.y()) << count;
  }
}

TEST(FigureLayout, DrawsGravityDownwards) {
  for (const int axis : {0, 1, 2}) {
    for (const int along : {0, 1, 2}) {
      for (const double sign : {-1.0, 1.0}) {
        const Vector3d gravity = sign * 9.81 * Vector3d::Unit(along);
        const auto views = ViewsFor(axis, gravity);
        EXPECT_LT(views[0].Of(gravity).y(), -9);
        EXPECT_NEAR(views[0].Of(gravity).x(), 0, 1e-12);
        // The second shows the base axis that the first does not.
        const int hidden = views[0].Viewer().component;
        EXPECT_TRUE(views[1].right.component == hidden || views[1].up.component == hidden);
        // From above where the robot is level.
        if (along != axis) {
          EXPECT_LT(views[1].Viewer().Of(gravity), -9);
        }
      }
    }
  }
}

TEST(FigureLayout, StandsUprightWithoutGravity) {
  EXPECT_EQ(ViewsFor(1, Vector3d::Zero())[0].up.component, 1);
  EXPECT_EQ(ViewsFor(1, Vector3d::Zero())[0].up.sign, 1);
}

TEST(FigureLayout, ShowsAllPointsAtOneScale) {
  Figure figure = Figured(4, kDown);
  figure.shapes[1].force = {0.1, 0.2, 0};
  figure.shapes[3].gravity = kLevel;
  const Layout layout = LayoutOf(figure);
  ASSERT_EQ(layout.panels.size(), 4u);  // hanging, level
  EXPECT_THAT(layout.panels[0].shapes, ::testing::ElementsAre(0, 1, 2));
  EXPECT_THAT(layout.panels[2].shapes, ::testing::ElementsAre(3));
  for (const Panel& panel : layout.panels) {
    EXPECT_EQ(panel.scale, layout.panels[0].scale);
    EXPECT_NEAR(panel.size.x(), panel.scale * panel.range.sizes().x(), 1e-9);
    EXPECT_NEAR(panel.size.y(), panel.scale * panel.range.sizes().y(), 1e-9);
    for (const std::size_t i : panel.shapes) {
      const Shape& shape = figure.shapes[i];
      const Vector3d head = shape.End() + layout.metres_per_newton * shape.force;
      EXPECT_TRUE(panel.range.contains(panel.view.Of(head)));
      for (const Vector3d& p : shape.backbone) EXPECT_TRUE(panel.range.contains(panel.view.Of(p)));
    }
  }
}

TEST(FigureLayout, SpreadsTheLoadsOverTheColourBar) {
  const LoadRange loads = LoadsOf(Figured(5));
  EXPECT_EQ(loads.Share(0), 0);
  EXPECT_EQ(loads.Share(4), 1);
  EXPECT_EQ(LoadsOf(Figured(1)).Share(0), 0.5);
}

TEST(FigureLayout, ColoursTheOrderOfCasesWhoseLoadsAreAlike) {
  Figure alike = Figured(5);
  for (Shape& shape : alike.shapes) shape.load = 36 + 1e-4 * shape.load;
  const Figure drawn = ColouredByOrderWhereLoadsAreAlike(alike);
  EXPECT_EQ(drawn.load_name, "number of the case");
  EXPECT_EQ(LoadsOf(drawn).low, 1);
  EXPECT_EQ(LoadsOf(drawn).high, 5);
  EXPECT_EQ(ColouredByOrderWhereLoadsAreAlike(Figured(5)).load_name, Figured(5).load_name);
}

TEST(Palette, EveryNamedCaseHasALineOfItsOwn) {
  std::set<std::tuple<double, double, double, std::vector<double>>> seen;
  for (std::size_t i = 0; i < 28; ++i) {
    const Pen pen = CasePen(i);
    seen.emplace(pen.colour.red, pen.colour.green, pen.colour.blue, pen.dash);
  }
  EXPECT_EQ(seen.size(), 28u);
  EXPECT_GE(28u, kMostNamed);
}

TEST(Palette, ViridisGrowsLighter) {
  const auto lightness = [](const Colour& c) {
    return 0.2126 * c.red + 0.7152 * c.green + 0.0722 * c.blue;
  };
  for (int i = 0; i < 50; ++i)
    EXPECT_LT(lightness(Viridis(i / 50.0)), lightness(Viridis((i + 1) / 50.0))) << i;
}

TEST(Marks, LongTextsAreCutBetweenLetters) {
  InkExtents([](Canvas& canvas) {
    const std::string text = "x\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9";
    const std::string cut = Fitting(text, 30, kSmall, canvas);
    EXPECT_LE(canvas.TextWidth(cut, kSmall), 30);
    EXPECT_THAT(cut, ::testing::EndsWith("\u00e9\u2026"));
    EXPECT_EQ(Fitting("short", 30, kSmall, canvas), "short");
  });
}

TEST(Marks, TheHullOfADiscIsItsOutline) {
  std::vector<PagePoint> points = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 1}, {1, 0}};
  EXPECT_EQ(Hull(points).size(), 4u);
}

}  // namespace
}  // namespace continuum::statics
