#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "report/synthetic_sweep.hpp"
#include "rift/report/page/page.hpp"
#include "rift/sweep/explain/explanation.hpp"
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
  CHECK(charts == 11);
  CHECK_THAT(visit.dom, Contains("data-drawn=\"" + std::to_string(charts) + "\""));
  // Effects, anatomy, failing region; dots, bins, cells; then a bar for each surface,
  // [v_min, v_max], surface, v_min, v_max.
  std::vector<long> marks;
  for (int i = 0; i < charts; ++i) {
    const std::string chart = Chart(visit.dom, i);
    CHECK_THAT(chart, Contains("<svg") && !Contains("NaN"));
    marks.push_back(CountOf(chart, "fill=\"#0072B2\"") + CountOf(chart, "fill=\"#D55E00\"") +
                    CountOf(chart, "fill=\"rgb("));
  }
  CHECK(marks == std::vector<long>{3, 5, 6, 23, 6, 12, 3, 4, 3, 2, 2});
  // 23 measured trials are dots; the lost one is a cross.
  const std::string dots = Chart(visit.dom, 3);
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

TEST_CASE("Cells that are numbers sort by their value before words and the empty cell") {
  const std::string probe = R"(
    const cells = ['word', '10', '0.5', '-0.03', '', '0.15', '-0.06', '9', '0.0123', '1e-3'];
    document.body.append('PROBE ' + cells.sort(compare).join('|') + ' END');)";
  const BrowserVisit visit = Visit(WithScript(RenderPage(synthetic::Grid()), probe));
  SKIP_WITHOUT_BROWSER(visit);
  CHECK_THAT(visit.dom, Contains("PROBE -0.06|-0.03|1e-3|0.0123|0.15|0.5|9|10||word END"));
}

TEST_CASE("Tooltips show what a mark stands for as plain text") {
  const std::string probe = R"(
    setTimeout(() => {
      const mark = document.querySelector('#chart-3 [fill="#D55E00"]');
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

std::string ForAttribute(const std::string& html) {
  std::string text;
  for (const char c : html) text += c == '&' ? "&amp;" : c == '"' ? "&quot;" : std::string(1, c);
  return text;
}

/// The page in a frame of that width, whose style and script see nothing wider; Chromium has no
/// window below 500 px. What the page sends to its parent ends up in the document.
std::string Framed(const std::string& page, int width_px) {
  return "<!DOCTYPE html><body style='margin:0'><iframe style='border:0' height=844 width=" +
         std::to_string(width_px) + " srcdoc=\"" + ForAttribute(page) +
         "\"></iframe><script>onmessage = e => document.body.append('PROBE ' + e.data + ' END');"
         "</script></body>";
}

/// Everything in which a page is no pleasure to read: elements that reach beyond the window, small
/// letters, labels of a chart over each other, charts without marks, unit or sentence.
constexpr const char* kReading = R"(
  const faults = new Set(), wide = document.documentElement.clientWidth + 0.5;
  const name = e => e.closest('figure')?.querySelector('h2').textContent ?? e.tagName;
  const look = () => {
    if (document.documentElement.scrollWidth > wide) faults.add('the page scrolls sideways');
    for (const e of document.querySelectorAll('main *')) {
      if (e.closest('table') || e.closest('svg')) continue;
      if (e.getBoundingClientRect().right > wide) faults.add('too wide: ' + name(e));
      if (parseFloat(getComputedStyle(e).fontSize) < 12) faults.add('small: ' + name(e));
    }
    for (const figure of document.querySelectorAll('figure')) {
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
    parent.postMessage(faults.size + ' faults: ' + [...faults].join('; '), '*');
  };
  const wait = () => document.body.dataset.drawn ? setTimeout(look, 300) : setTimeout(wait, 50);
  wait();)";

TEST_CASE("A page is pleasant to read on a laptop and on a phone") {
  for (const auto& result : {synthetic::Grid(), synthetic::Continuous(300)}) {
    const sweep::Explanation explanation = sweep::Explain(result);
    PageEvidence evidence;
    if (!explanation.clusters.empty()) {
      evidence.failures = {{explanation.clusters[0].rows[0], 0, synthetic::Pair(0.08, "robot")}};
    }
    const std::string page = WithScript(RenderPage(result, explanation, evidence), kReading);
    for (const int width_px : {390, 1366}) {
      const BrowserVisit visit = Visit(Framed(page, width_px));
      SKIP_WITHOUT_BROWSER(visit);
      INFO(result.name << " at " << width_px << " px");
      const std::size_t at = visit.dom.rfind("PROBE ");
      REQUIRE(at != std::string::npos);
      CHECK(visit.dom.substr(at, visit.dom.find(" END", at) - at) == "PROBE 0 faults: ");
      CHECK(visit.console == "");
      CHECK(visit.requests == "");
    }
  }
}

TEST_CASE("The reading test sees what is wrong with a page") {
  std::string page = WithScript(RenderPage(synthetic::Grid()), kReading);
  page.insert(page.find("</style>"), "figcaption{font-size:9px} h1{width:2000px}");
  const BrowserVisit visit = Visit(Framed(page, 390));
  SKIP_WITHOUT_BROWSER(visit);
  CHECK_THAT(visit.dom, Contains("the page scrolls sideways") && Contains("small: "));
}

TEST_CASE("A page of many thousand trials opens") {
  const BrowserVisit visit = Visit(RenderPage(synthetic::Continuous(8000)));
  SKIP_WITHOUT_BROWSER(visit);
  CHECK(visit.console == "");
  CHECK_THAT(visit.dom, Contains("data-drawn=\"7\""));
}

}  // namespace
}  // namespace rift::report
