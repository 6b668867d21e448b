#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <string>

#include "sim/io/file.h"

namespace continuum::testing {

/// What headless Chromium saw when it opened a page.
struct BrowserView {
  std::string errors;     ///< uncaught errors and everything on the console; empty = clean
  std::string dom;        ///< the document after its scripts ran
  int charts = 0;         ///< time series panels that have a width
  int blank = 0;          ///< those without a pixel in the colour of one of their series
  int height = 0;         ///< of the whole page [px]
  bool external = false;  ///< something besides the page itself was requested or is linked
  std::filesystem::path screenshot;  ///< PNG of the whole page
};

struct BrowserOptions {
  bool dark = false;
  int width = 1200;
};

/// Path of the browser, empty when there is none.
inline std::string FindChromium() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
      const std::string file = folder + "/" + name;
      if (access(file.c_str(), X_OK) == 0) return file;
    }
  }
  return "";
}

#define CONTINUUM_REQUIRE_CHROMIUM() \
  if (continuum::testing::FindChromium().empty()) GTEST_SKIP() << "no chromium in PATH"

namespace browser {

// Runs before anything else in the page.
inline constexpr const char* kCollector = R"(<script>
window.probeErrors = [];
addEventListener('error', (event) => window.probeErrors.push(
    event.message || 'cannot load ' + event.target.src), true);
</script>)";

// Runs after everything else. A chart counts as drawn when a canvas has a pixel in a colour that
// its legend shows; axes and grid have other colours.
inline constexpr const char* kProbe = R"(<script>
addEventListener('load', () => {
  const rgb = (text) => text.match(/[\d.]+/g).slice(0, 3).map(Number);
  const inked = (chart) => {
    const keys = [...chart.closest('figure').querySelectorAll('.key > i')];
    const colours = keys.map((key) => rgb(getComputedStyle(key).color));
    let count = 0;
    for (const canvas of chart.querySelectorAll('canvas')) {
      const {data} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
      for (let i = 0; i < data.length; i += 4) {
        if (data[i + 3] < 128) continue;
        count += colours.some((c) => Math.hypot(data[i] - c[0], data[i + 1] - c[1],
                                                data[i + 2] - c[2]) < 12);
      }
    }
    return count;
  };
  const charts = [...document.querySelectorAll('.chart')].filter((c) => c.offsetWidth > 0);
  const links = [...document.querySelectorAll('[src], [href]')].map(
      (element) => element.getAttribute('src') || element.getAttribute('href'));
  const requested = [...performance.getEntriesByType('resource').map((entry) => entry.name),
                     ...links.filter((link) => !link.startsWith('#'))];
  const probe = document.createElement('template');
  probe.id = 'probe';
  probe.dataset.charts = charts.length;
  probe.dataset.blank = charts.filter((chart) => inked(chart) === 0).length;
  probe.dataset.height = document.documentElement.scrollHeight;
  probe.dataset.errors = window.probeErrors.join(' | ');
  probe.dataset.requested = requested.join(' ');
  document.body.append(probe);
});
</script>)";

inline std::string Attribute(const std::string& dom, const std::string& name) {
  const auto probe = dom.find("<template id=\"probe\"");
  if (probe == dom.npos) throw std::runtime_error("the browser did not run the page");
  const auto start = dom.find("data-" + name + "=\"", probe);
  if (start == dom.npos) throw std::runtime_error("the probe did not report " + name);
  const auto from = dom.find('"', start) + 1;
  return dom.substr(from, dom.find('"', from) - from);
}

inline std::string Quoted(const std::filesystem::path& path) { return "'" + path.string() + "'"; }

inline void Run(const std::filesystem::path& folder, const std::string& arguments,
                const BrowserOptions& options, const std::filesystem::path& page) {
  const std::string command =
      "timeout 120 " + Quoted(FindChromium()) +
      " --headless=new --no-sandbox --disable-gpu --hide-scrollbars --no-first-run"
      " --disable-extensions --disable-background-networking --disable-dev-shm-usage"
      " --enable-logging=stderr --v=0 --virtual-time-budget=2000 "
      "--blink-settings=preferredColorScheme=" +
      std::string(options.dark ? "0" : "1") + " --user-data-dir=" + Quoted(folder / "profile") +
      " " + arguments + " 'file://" + page.string() + "' > " + Quoted(folder / "out") + " 2> " +
      Quoted(folder / "log");
  if (std::system(command.c_str()) != 0) {
    throw std::runtime_error("chromium failed: " + ReadFile(folder / "log"));
  }
}

inline std::string ConsoleLines(const std::filesystem::path& log) {
  std::istringstream lines(ReadFile(log));
  std::string out;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("CONSOLE") != line.npos) out += line + "\n";
  }
  return out;
}

}  // namespace browser

/// Opens `page` in headless Chromium; working files and the screenshot go to `folder` (absolute,
/// without quotes). Throws when the browser cannot be run.
inline BrowserView OpenInChromium(const std::filesystem::path& page,
                                  const std::filesystem::path& folder,
                                  const BrowserOptions& options = {}) {
  std::filesystem::create_directories(folder);
  std::string html = ReadFile(page);
  const auto head = html.find("<head>");
  const auto end = html.rfind("</body>");
  if (head == html.npos || end == html.npos) throw std::runtime_error("not a whole HTML page");
  html.insert(end, browser::kProbe);
  html.insert(head + 6, browser::kCollector);
  const std::filesystem::path probed = folder / "probed.html";
  WriteFile(probed, html);

  BrowserView view;
  const std::string width = std::to_string(options.width);
  browser::Run(folder, "--dump-dom --window-size=" + width + ",900", options, probed);
  view.dom = ReadFile(folder / "out");
  view.errors = browser::Attribute(view.dom, "errors") + browser::ConsoleLines(folder / "log");
  view.charts = std::stoi(browser::Attribute(view.dom, "charts"));
  view.blank = std::stoi(browser::Attribute(view.dom, "blank"));
  view.height = std::stoi(browser::Attribute(view.dom, "height"));
  view.external = !browser::Attribute(view.dom, "requested").empty();

  view.screenshot = folder / (options.dark ? "dark.png" : "light.png");
  const std::string height = std::to_string(std::min(view.height, 16000));
  browser::Run(
      folder,
      "--screenshot=" + browser::Quoted(view.screenshot) + " --window-size=" + width + "," + height,
      options, page);
  std::filesystem::remove_all(folder / "profile");
  return view;
}

}  // namespace continuum::testing
