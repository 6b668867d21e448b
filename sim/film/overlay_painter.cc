#include "sim/film/overlay_painter.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/io/rounded.h"
#include "sim/numerics/round_number.h"

namespace continuum {
namespace {

std::string LengthText(double metres) {
  return metres < 1 ? fmt::format("{:g} mm", 1e3 * metres) : fmt::format("{:g} m", metres);
}

// MuJoCo's fonts have the printable ASCII characters only.
std::string Ascii(const std::string& text) {
  static const std::vector<std::pair<std::string, std::string>> kSpelled = {
      {"°", " deg"}, {"µ", "u"},  {"μ", "u"},  {"×", "x"},  {"·", "."},  {"²", "^2"},
      {"³", "^3"},   {"ä", "ae"}, {"ö", "oe"}, {"ü", "ue"}, {"Ä", "Ae"}, {"Ö", "Oe"},
      {"Ü", "Ue"},   {"ß", "ss"}, {"é", "e"},  {"è", "e"},  {"ê", "e"},  {"á", "a"},
      {"à", "a"},    {"í", "i"},  {"ó", "o"},  {"ú", "u"},  {"ñ", "n"},  {"ç", "c"},
      {"–", "-"},    {"—", "-"},  {"−", "-"},  {"±", "+-"}, {"’", "'"},  {"…", "..."}};
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c < 0x80) {
      out += c == '\n' || (c >= 32 && c < 127) ? text[i] : ' ';
      ++i;
      continue;
    }
    const auto it = std::find_if(kSpelled.begin(), kSpelled.end(), [&](const auto& s) {
      return text.compare(i, s.first.size(), s.first) == 0;
    });
    out += it == kSpelled.end() ? "?" : it->second;
    if (it != kSpelled.end())
      i += it->first.size();
    else
      while (++i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0) == 0x80) {
      }
  }
  return out;
}

class Painter {
 public:
  Painter(const Font& font, Image& image)
      : font_(font), image_(image), pad_(2 * font.line / 5), line_(font.line) {}

  void Caption(const std::string& text) {
    const std::vector<std::string> lines = Wrap(Ascii(text), image_.width - 4 * pad_);
    int widest = 0;
    for (const std::string& line : lines) widest = std::max(widest, font_.Width(line));
    Plate(pad_, pad_, widest + 2 * pad_, line_ * static_cast<int>(lines.size()) + pad_);
    int top = pad_ + pad_ / 2;
    for (const std::string& line : lines) {
      Line(line, 2 * pad_, top);
      top += line_;
    }
  }

  void Time(double time) {
    const std::string text = "t = " + Fixed(time, 2) + " s";
    const int top = image_.height - 2 * pad_ - line_;
    Plate(pad_, top, font_.Width(text) + 2 * pad_, line_ + pad_);
    Line(text, 2 * pad_, top + pad_ / 2);
    free_ = 3 * pad_ + font_.Width(text);
  }

  // A length and its text, in the left half.
  void Scale(const Ruler& ruler) {
    const std::string text = LengthText(ruler.length);
    const int bar = static_cast<int>(std::lround(ruler.length / ruler.pixel));
    const int left = free_ + pad_, width = bar + font_.Width(text) + 3 * pad_;
    if (left + width > image_.width / 2) return;
    const int top = image_.height - 2 * pad_ - line_, middle = top + (line_ + pad_) / 2;
    const int thick = std::max(2, line_ / 8), tick = line_ / 4, from = left + pad_;
    Plate(left, top, width, line_ + pad_);
    Fill(from, middle - thick / 2, bar, thick);
    Fill(from, middle - tick, thick, 2 * tick);
    Fill(from + bar - thick, middle - tick, thick, 2 * tick);
    Line(text, from + bar + pad_, top + pad_ / 2);
  }

  // The label, and below it: low, the colours, high.
  void Bar(const ColorBar& bar) {
    const std::string label = Ascii(bar.label), low = Ascii(bar.low), high = Ascii(bar.high);
    const int ends = font_.Width(low) + font_.Width(high) + 2 * pad_;
    const int inner = std::max(font_.Width(label), ends + 6 * line_);
    const int left = image_.width - inner - 2 * pad_;
    const int top = image_.height - 2 * line_ - 5 * pad_ / 2;
    Plate(left - pad_, top, inner + 2 * pad_, 2 * line_ + 3 * pad_ / 2);
    Line(label, left, top + pad_ / 2);
    const int row = top + pad_ + line_, from = left + font_.Width(low) + pad_;
    Line(low, left, row);
    Line(high, from + inner - ends + pad_, row);
    Gradient(bar, from, row + line_ / 5, inner - ends, 3 * line_ / 5);
  }

 private:
  using Color = std::array<float, 3>;

  void Blend(int x, int y, const Color& color, float opacity) {
    if (x < 0 || y < 0 || x >= image_.width || y >= image_.height) return;
    unsigned char* const pixel = image_.rgb.data() + 3 * (std::ptrdiff_t{y} * image_.width + x);
    for (int c = 0; c < 3; ++c) {
      const auto old = static_cast<float>(pixel[c]);
      pixel[c] = static_cast<unsigned char>(old + opacity * (255 * color[c] - old) + 0.5f);
    }
  }
  void Plate(int left, int top, int width, int height) {
    for (int y = top; y < top + height; ++y) {
      for (int x = left; x < left + width; ++x) Blend(x, y, {0.05f, 0.07f, 0.10f}, 0.62f);
    }
  }
  void Fill(int left, int top, int width, int height) {
    for (int y = top; y < top + height; ++y) {
      for (int x = left; x < left + width; ++x) Blend(x, y, {1, 1, 1}, 1);
    }
  }
  void Line(const std::string& text, int left, int top) {
    for (const char character : text) {
      const auto c = static_cast<unsigned char>(character);
      const int width = font_.width[c];
      for (std::size_t i = 0; i < font_.cover[c].size(); ++i) {
        const auto k = static_cast<int>(i);
        const float cover = static_cast<float>(font_.cover[c][i]) / 255;
        if (cover > 0) Blend(left + k % width, top + k / width, {1, 1, 1}, cover);
      }
      left += width;
    }
  }
  void Gradient(const ColorBar& bar, int left, int top, int width, int height) {
    for (int x = 0; x < width; ++x) {
      const float share = (static_cast<float>(x) + 0.5f) / static_cast<float>(width);
      Color color;
      for (int c = 0; c < 3; ++c) {
        color[c] = std::clamp(std::lerp(bar.from[c], bar.to[c], share), 0.0f, 1.0f);
      }
      for (int y = 0; y < height; ++y) Blend(left + x, top + y, color, 1);
    }
  }

  // At spaces; a word longer than a line goes on in the next.
  std::vector<std::string> Wrap(const std::string& text, int width) const {
    std::vector<std::string> lines(1);
    std::size_t space = std::string::npos;  // last one of the line
    for (const char c : text) {
      if (c == '\n') {
        lines.emplace_back();
        space = std::string::npos;
        continue;
      }
      if (c == ' ') space = lines.back().size();
      lines.back() += c;
      if (font_.Width(lines.back()) <= width || lines.back().size() == 1) continue;
      const std::size_t cut = space == std::string::npos ? lines.back().size() - 1 : space;
      std::string rest = lines.back().substr(space == std::string::npos ? cut : cut + 1);
      lines.back().resize(cut);
      lines.push_back(std::move(rest));
      space = std::string::npos;
    }
    return lines;
  }

  const Font& font_;
  Image& image_;
  int pad_, line_;
  int free_ = 0;  // of the lowest line, from here on [px]
};

}  // namespace

Font::Font(const mjrContext& context) : line(context.charHeight * 5 / 4) {
  std::copy_n(context.charWidth, width.size(), width.begin());
  for (std::size_t c = 33; c < cover.size(); ++c) {
    const std::array<char, 2> text = {static_cast<char>(c), '\0'};
    const mjrRect box = {0, 0, width[c], line};
    mjr_label(box, mjFONT_NORMAL, text.data(), 0, 0, 0, 1, 1, 1, 1, &context);
    std::vector<unsigned char> rgb(3 * static_cast<std::size_t>(box.width) * box.height);
    mjr_readPixels(rgb.data(), nullptr, box, &context);
    for (int y = line - 1; y >= 0; --y) {
      for (int x = 0; x < width[c]; ++x) cover[c].push_back(rgb[3 * (y * width[c] + x)]);
    }
  }
}

int Font::Width(const std::string& text) const {
  int sum = 0;
  for (const char c : text) sum += width[static_cast<unsigned char>(c)];
  return sum;
}

void Ruler::Measure(double pixel_length, int width) {
  pixel = pixel_length;
  if (pixel <= 0) return;
  const double wanted = pixel * width / 8;
  if (length < 0.3 * wanted || length > 1.5 * wanted) length = RoundDown(wanted);
}

void Paint(const Overlay& overlay, const Font& font, Image& image) {
  Painter painter(font, image);
  if (!overlay.caption.empty()) painter.Caption(overlay.caption);
  if (overlay.time) painter.Time(*overlay.time);
  if (overlay.ruler && overlay.ruler->pixel > 0) painter.Scale(*overlay.ruler);
  if (overlay.bar) painter.Bar(*overlay.bar);
}

}  // namespace continuum
