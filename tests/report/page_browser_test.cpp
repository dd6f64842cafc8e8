#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "report/framed_pages.hpp"
#include "rift/report/page/page.hpp"
#include "rift/sweep/explain/explanation.hpp"
#include "rift/sweep/falsify/evidence.hpp"
#include "support/processes/browser.hpp"

namespace rift::report {
namespace {

using Catch::Matchers::Contains;
using test::BrowserVisit;
using test::Visit;

long CountOf(const std::string& text, const std::string& word) {
  long n = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++n;
  return n;
}

/// The markup of one chart in the document.
std::string Chart(const std::string& dom, int index) {
  const std::string open = "id=\"chart-" + std::to_string(index) + "\"";
  const std::size_t begin = dom.find(open);
  if (begin == std::string::npos) return "";
  return dom.substr(begin, dom.find("</figure>", begin) - begin);
}

TEST_CASE("The browser test sees a request and an error when there are some") {
  const BrowserVisit visit = Visit(
      "<!DOCTYPE html><body><img src='http://127.0.0.1:9/x.png'>"
      "<script>console.error('seen'); throw new Error('thrown');</script></body>");
  SKIP_WITHOUT_BROWSER(visit);
  CHECK_THAT(visit.requests, Contains("http://127.0.0.1:9/x.png"));
  CHECK_THAT(visit.console, Contains("seen") && Contains("thrown"));
}

TEST_CASE("The page opens without an error, asks the network for nothing and draws every chart") {
  const BrowserVisit many = Visit(RenderPage(synthetic::Continuous(300)));
  SKIP_WITHOUT_BROWSER(many);
  CHECK(many.console == "");
  CHECK(many.requests == "");
  const BrowserVisit grid = Visit(RenderPage(synthetic::Grid()));
  CHECK(grid.console == "");
  CHECK(grid.requests == "");
  CHECK_THAT(grid.dom, Contains("data-drawn=\"4\""));
  // Failing region, effects, anatomy, bins (11 of which are below the threshold, 3 above).
  std::vector<long> marks;
  for (int i = 0; i < 4; ++i) {
    const std::string chart = Chart(grid.dom, i);
    CHECK_THAT(chart, Contains("<svg") && !Contains("NaN"));
    marks.push_back(CountOf(chart, "fill=\"#0072B2\"") + CountOf(chart, "fill=\"#D55E00\"") +
                    CountOf(chart, "fill=\"rgb("));
  }
  CHECK(marks[0] == 6);
  CHECK(marks[1] == 3);
  CHECK(marks[2] == 5);
  CHECK(marks[3] >= 24);
  CHECK_THAT(Chart(grid.dom, 0), Contains(">sand_fine<"));
}

TEST_CASE("A page in a folder whose name is no UTF-8 draws every chart") {
  const BrowserVisit visit = Visit(RenderPage(synthetic::Grid()), "o\xff");
  SKIP_WITHOUT_BROWSER(visit);
  CHECK(visit.console == "");
  CHECK_THAT(visit.dom, Contains("data-drawn=\"4\"") && Contains("rift simulate --replay DIR 1"));
}

/// Everything in which a page is no pleasure to read: elements that reach beyond the window, small
/// letters, labels of a chart over each other, charts without marks, unit or sentence.
constexpr const char* kReading = R"(
  const faults = new Set(), wide = document.documentElement.clientWidth + 0.5;
  const name = e => e.closest('figure')?.querySelector('h2, h3').textContent ?? e.tagName;
  const look = () => {
    if (document.documentElement.scrollWidth > wide) faults.add('the page scrolls sideways');
    for (const e of document.querySelectorAll('main *')) {
      if (e.closest('table') || e.closest('svg')) continue;
      if (e.getBoundingClientRect().right > wide) faults.add('too wide: ' + name(e));
      if (parseFloat(getComputedStyle(e).fontSize) < 12) faults.add('small: ' + name(e));
    }
    for (const figure of document.querySelectorAll('figure:has(.chart)')) {
      const edge = figure.getBoundingClientRect();
      const texts = [...figure.querySelectorAll('svg text')].filter(t => t.textContent.trim() !== '' &&
        getComputedStyle(t).opacity !== '0');
      for (const t of texts) {
        const box = t.getBoundingClientRect();
        if (box.left < edge.left - 1 || box.right > edge.right + 1) {
          faults.add('cut off: ' + t.textContent + ' in ' + name(t));
        }
        if (parseFloat(getComputedStyle(t).fontSize) < 11) faults.add('small: ' + t.textContent);
      }
      const level = texts.filter(t => !/rotate/.test(t.getAttribute('transform')));
      level.forEach((a, i) => level.slice(i + 1).forEach(b => {
        const p = a.getBoundingClientRect(), q = b.getBoundingClientRect();
        const x = Math.min(p.right, q.right) - Math.max(p.left, q.left);
        const y = Math.min(p.bottom, q.bottom) - Math.max(p.top, q.top);
        if (x > 1 && y > 3) faults.add(`over each other: ${a.textContent}, ${b.textContent} in ${name(a)}`);
      }));
      if (!figure.querySelector('svg [aria-roledescription$="mark container"] path')) {
        faults.add('empty: ' + name(figure));
      }
      const caption = figure.querySelector('figcaption').textContent;
      if (!/\.$/.test(caption)) faults.add('no sentence: ' + name(figure));
      if (!/metre|per cent|number|share|%/i.test(caption)) faults.add('no unit: ' + name(figure));
    }
    const cards = document.querySelector('.cards').getBoundingClientRect();
    if (wide > 1300 && cards.bottom + scrollY > 720) faults.add('first screen ends at ' + cards.bottom);
    if (!document.querySelector('#paths polyline.reference')) faults.add('no path');
    if (document.querySelectorAll('.cards article').length > 3) faults.add('too many cards');
    parent.postMessage(faults.size + ' faults: ' + [...faults].join('; '), '*');
  };
  const wait = () => document.body.dataset.drawn ? setTimeout(look, 300) : setTimeout(wait, 50);
  wait();)";

TEST_CASE("A page is pleasant to read on a laptop and on a phone") {
  sweep::SweepResult continuous = synthetic::Continuous(300);
  continuous.rows[0].evidence.path_m = sweep::EvenPath(synthetic::Path(0.05), {});
  std::vector<PageAtWidth> pages;
  for (const auto& result : {GridWithPaths(), continuous}) {
    const PageEvidence evidence{
        .references = {{"robot, trial 1", sweep::EvenPath(synthetic::Path(0.0), {})}},
        .reference_of_row = std::vector<int>(result.rows.size(), 0)};
    const std::string page =
        WithScript(RenderPage(result, sweep::Explain(result), evidence), kReading);
    for (const int width_px : {390, 1366}) pages.push_back({page, width_px});
  }
  const BrowserVisit visit = Visit(Framed(pages));
  SKIP_WITHOUT_BROWSER(visit);
  for (std::size_t i = 0; i < pages.size(); ++i) {
    INFO((i < 2 ? "grid" : "continuous") << " at " << pages[i].width_px << " px");
    const std::string begin = "PROBE " + std::to_string(i) + ": ";
    CHECK(Probe(visit, begin) == begin + "0 faults: ");
  }
  CHECK(visit.console == "");
  CHECK(visit.requests == "");
}

TEST_CASE("The reading test sees what is wrong with a page") {
  std::string page = WithScript(RenderPage(synthetic::Grid()), kReading);
  page.insert(page.find("</style>"), "figcaption{font-size:9px} h1{width:2000px}");
  const BrowserVisit visit = Visit(Framed({{page, 390}}));
  SKIP_WITHOUT_BROWSER(visit);
  CHECK_THAT(visit.dom, Contains("the page scrolls sideways") && Contains("small: "));
}

TEST_CASE("A page of many thousand trials opens") {
  const BrowserVisit visit = Visit(RenderPage(synthetic::Continuous(8000)));
  SKIP_WITHOUT_BROWSER(visit);
  CHECK(visit.console == "");
  CHECK_THAT(visit.dom, Contains("data-drawn=\"4\""));
}

}  // namespace
}  // namespace rift::report
