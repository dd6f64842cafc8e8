#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "report/synthetic_sweep.hpp"
#include "rift/report/page.hpp"
#include "support/browser.hpp"

namespace rift::report {
namespace {

using Catch::Matchers::Contains;
using test::BrowserVisit;
using test::Visit;

#define SKIP_WITHOUT_BROWSER(visit)                        \
  if (!(visit).available) {                                \
    WARN("SKIPPED: there is no chromium on this machine"); \
    return;                                                \
  }

std::string WithScript(std::string page, const std::string& script) {
  const std::size_t end = page.rfind("</body>");
  return page.insert(end, "<script>" + script + "</script>");
}

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

TEST_CASE("The page opens without an error and asks the network for nothing") {
  for (const auto& result : {synthetic::Grid(), synthetic::Continuous(300)}) {
    const BrowserVisit visit = Visit(RenderPage(result));
    SKIP_WITHOUT_BROWSER(visit);
    CHECK(visit.console == "");
    CHECK(visit.requests == "");
  }
}

TEST_CASE("Every chart is drawn with marks for its data") {
  const sweep::SweepResult result = synthetic::Grid();
  const BrowserVisit visit = Visit(RenderPage(result));
  SKIP_WITHOUT_BROWSER(visit);
  const long charts = CountOf(visit.dom, "<figure>");
  CHECK(charts == 8);
  CHECK_THAT(visit.dom, Contains("data-drawn=\"" + std::to_string(charts) + "\""));
  // Dots, bins, cells, then a bar for each surface, [v_min, v_max], surface, v_min, v_max.
  std::vector<long> marks;
  for (int i = 0; i < charts; ++i) {
    const std::string chart = Chart(visit.dom, i);
    CHECK_THAT(chart, Contains("<svg") && !Contains("NaN"));
    marks.push_back(CountOf(chart, "fill=\"#0072B2\"") + CountOf(chart, "fill=\"#D55E00\"") +
                    CountOf(chart, "fill=\"rgb("));
  }
  CHECK(marks == std::vector<long>{23, 6, 12, 3, 4, 3, 2, 2});
  // 23 measured trials are dots; the lost one is a cross.
  const std::string dots = Chart(visit.dom, 0);
  CHECK(CountOf(dots, "fill=\"#0072B2\"") == 15);
  CHECK(CountOf(dots, "fill=\"#D55E00\"") == 8);
  CHECK_THAT(dots, Contains("sand_fine [0.15, 0.30]"));
}

TEST_CASE("A click on a heading sorts the table and a second one turns it round") {
  const std::string probe = R"(
    const heading = [...document.querySelectorAll('#trials th')]
      .find(th => th.textContent === 'gap (m)');
    const column = heading.cellIndex, seen = [];
    const look = () => seen.push(heading.getAttribute('aria-sort'),
      document.querySelector('#trials tbody tr').cells[column].textContent,
      document.querySelector('#trials tbody tr:last-child').cells[column].textContent);
    look();
    heading.querySelector('button').click(); look();
    heading.querySelector('button').click(); look();
    document.body.append('PROBE ' + seen.join('|') + ' END');)";
  const BrowserVisit visit = Visit(WithScript(RenderPage(synthetic::Grid()), probe));
  SKIP_WITHOUT_BROWSER(visit);
  // The trial without a gap stays last either way.
  CHECK_THAT(visit.dom,
             Contains("PROBE none|0.0260|0.0740|ascending|0.0260|–|descending|0.0740|– END"));
}

TEST_CASE("Tooltips show what a mark stands for as plain text") {
  const std::string probe = R"(
    setTimeout(() => {
      const mark = document.querySelector('#chart-0 [fill="#D55E00"]');
      const box = mark.getBoundingClientRect();
      mark.dispatchEvent(new MouseEvent('mousemove', {bubbles: true,
        clientX: box.x + box.width / 2, clientY: box.y + box.height / 2}));
      mark.dispatchEvent(new MouseEvent('mouseover', {bubbles: true,
        clientX: box.x + box.width / 2, clientY: box.y + box.height / 2}));
      setTimeout(() => document.body.append('PROBE ' + tip.hidden + ' ' + tip.innerHTML), 200);
    }, 1000);)";
  const BrowserVisit visit =
      Visit(WithScript(RenderPage(synthetic::Grid({"ice", "snow", "<b>rock"})), probe));
  SKIP_WITHOUT_BROWSER(visit);
  CHECK_THAT(visit.dom,
             Contains("PROBE false") && Contains("surface: ") && Contains("&amp;lt;b&amp;gt;rock"));
}

TEST_CASE("Neither a phone nor a laptop scrolls the page sideways") {
  for (const int width_px : {390, 1280}) {
    // Chromium has no window below 500 px, so the page is squeezed by its root.
    std::string page = RenderPage(synthetic::Grid());
    const std::string style = "html{width:" + std::to_string(width_px) + "px}";
    page.insert(page.find("</style>"), style);
    const std::string measure = R"(
      setTimeout(() => {
        const over = [...document.querySelectorAll('main, figure, figure svg, .findings, .scroll')]
          .filter(e => e.getBoundingClientRect().right > )" +
                                std::to_string(width_px) + R"(.5);
        document.body.append('PROBE ' + over.map(e => e.tagName).join(' ') + ' END');
      }, 1000);)";
    const BrowserVisit visit = Visit(WithScript(page, measure));
    SKIP_WITHOUT_BROWSER(visit);
    INFO(width_px);
    CHECK_THAT(visit.dom, Contains("PROBE  END"));
  }
}

TEST_CASE("A page of many thousand trials opens") {
  const BrowserVisit visit = Visit(RenderPage(synthetic::Continuous(8000)));
  SKIP_WITHOUT_BROWSER(visit);
  CHECK(visit.console == "");
  CHECK_THAT(visit.dom, Contains("data-drawn=\"4\""));
}

}  // namespace
}  // namespace rift::report
