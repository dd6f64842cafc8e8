#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "report/synthetic_sweep.hpp"
#include "report/uneven_sweep.hpp"
#include "rift/report/page/page.hpp"
#include "rift/sweep/explain/explanation.hpp"
#include "rift/sweep/falsify/evidence.hpp"
#include "support/processes/browser.hpp"

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
  CHECK_THAT(visit.dom, Contains("data-drawn=\"4\""));
  // Failing region, effects, anatomy, bins (11 of which are below the threshold, 3 above).
  std::vector<long> marks;
  for (int i = 0; i < 4; ++i) {
    const std::string chart = Chart(visit.dom, i);
    CHECK_THAT(chart, Contains("<svg") && !Contains("NaN"));
    marks.push_back(CountOf(chart, "fill=\"#0072B2\"") + CountOf(chart, "fill=\"#D55E00\"") +
                    CountOf(chart, "fill=\"rgb("));
  }
  CHECK(marks[0] == 6);
  CHECK(marks[1] == 3);
  CHECK(marks[2] == 5);
  CHECK(marks[3] >= 24);
  CHECK_THAT(Chart(visit.dom, 0), Contains(">sand_fine<"));
}

/// The text from `begin` to END that a script put into the document.
std::string Probe(const BrowserVisit& visit, const std::string& begin = "PROBE ") {
  const std::size_t at = visit.dom.rfind(begin);
  if (at == std::string::npos) return "no probe: " + visit.console;
  return visit.dom.substr(at, visit.dom.find(" END", at) - at);
}

std::string WhenDrawn(const std::string& script) {
  return "const probe = text => document.body.append('PROBE ' + text + ' END');"
         "const wait = () => document.body.dataset.drawn ? setTimeout(() => {" +
         script + "}, 100) : setTimeout(wait, 50); wait();";
}

sweep::SweepResult GridWithPaths() {
  sweep::SweepResult result = synthetic::Grid();
  for (std::size_t i = 0; i < result.rows.size(); ++i) {
    if (!result.rows[i].IsOk()) continue;
    result.rows[i].evidence.path_m =
        sweep::EvenPath(synthetic::Path(0.002 * static_cast<double>(i)), {});
  }
  return result;
}

std::string PageWithPaths() {
  const sweep::SweepResult result = GridWithPaths();
  PageEvidence evidence{
      .references = {{"robot, trial 1", sweep::EvenPath(synthetic::Path(0.0), {})}},
      .reference_of_row = std::vector<int>(result.rows.size(), 0)};
  return RenderPage(result, sweep::Explain(result), evidence);
}

TEST_CASE("Sentence, tables, paths and charts follow the filter") {
  const std::string look = R"(
    const choice = document.getElementById('view');
    choice.value = [...choice.options].findIndex(option => option.textContent === 'rock');
    choice.dispatchEvent(new Event('change'));
    setTimeout(() => probe([document.getElementById('headline').textContent,
      document.querySelectorAll('#settings tbody tr').length,
      document.querySelectorAll('#trials tbody tr').length,
      document.querySelectorAll('#paths svg:not(.strip) .other').length,
      document.querySelectorAll('#chart-0 [fill^="rgb"]').length].join('|')), 300);)";
  const BrowserVisit visit = Visit(WithScript(PageWithPaths(), WhenDrawn(look)));
  SKIP_WITHOUT_BROWSER(visit);
  const std::string seen = Probe(visit);
  CHECK_THAT(seen, Contains("surface rock: ") && Contains("It fails: 8 of 8 measured trials"));
  // 4 settings, 8 trials, of which one is the worst and no other line; 2 cells of rock are left.
  CHECK_THAT(seen, Contains("|4|8|7|2"));
  CHECK(visit.console == "");
}

TEST_CASE("Links of the page show the rows that they count, fallen robots included") {
  const std::string look = R"(
    const seen = [], links = ['result=failed', 'surface=parchment&result=failed', 'row=3%2C5%2C8',
      'surface=ground', 'result=fell', 'v_min=0.25&surface=parchment&delay_s=0.02'];
    const next = () => {
      if (seen.length === links.length) { probe(seen.join('|')); return; }
      location.hash = '#trials?' + links[seen.length];
      setTimeout(() => {
        seen.push([...document.querySelectorAll('#trials tbody tr')].length);
        next();
      }, 50);
    };
    next();)";
  const sweep::SweepResult result = synthetic::Uneven();
  const BrowserVisit visit = Visit(WithScript(RenderPage(result), WhenDrawn(look)));
  SKIP_WITHOUT_BROWSER(visit);
  long failed = 0, on_parchment = 0, on_ground = 0;
  for (const sweep::TrialRow& row : result.rows) {
    failed += row.falsified ? 1 : 0;
    on_parchment += row.falsified && row.theta[1].text == "parchment" ? 1 : 0;
    on_ground += row.theta[1].text == "ground" ? 1 : 0;
  }
  CHECK(Probe(visit) == fmt::format("PROBE {}|{}|3|{}|1|3", failed, on_parchment, on_ground));
  CHECK(visit.console == "");
}

TEST_CASE("The pointer and the focus on a row light its path and say what it is") {
  const std::string look = R"(
    const row = document.querySelector('#trials tbody tr[data-row="5"]');
    const seen = [];
    const note = () => seen.push(document.querySelectorAll('#paths svg:not(.strip) .lit polyline').length,
      document.getElementById('paths-lit').textContent);
    row.cells[0].dispatchEvent(new MouseEvent('mouseover', {bubbles: true})); note();
    row.closest('table').dispatchEvent(new MouseEvent('mouseleave')); note();
    row.querySelector('button').focus(); note();
    probe(seen.join('|'));)";
  const BrowserVisit visit = Visit(WithScript(PageWithPaths(), WhenDrawn(look)));
  SKIP_WITHOUT_BROWSER(visit);
  const std::string row = "Row 5: ice, v_min 0.20, v_max 0.30, trial 1: gap 0.0260 m.";
  CHECK_THAT(Probe(visit), Contains("PROBE 2|" + row + "|0|Worst: row") && Contains("|2|" + row));
}

/// Of paths of about 1 m in 64 steps. The sixth row has no times.
std::string PageWithSpeeds() {
  sweep::SweepResult result = GridWithPaths();
  const auto times = [](float step_s) {
    std::vector<float> times_s;
    for (int k = 0; k <= sweep::kPathSteps; ++k) times_s.push_back(step_s * static_cast<float>(k));
    return times_s;
  };
  for (std::size_t i = 0; i < result.rows.size(); ++i) {
    result.rows[i].evidence.path_times_s = times(0.02F + 0.02F * static_cast<float>(i));
  }
  result.rows[5].evidence.path_times_s = {};
  PageEvidence evidence{
      .references = {{"robot, trial 1", sweep::EvenPath(synthetic::Path(0.0), {}), times(0.05F)}},
      .reference_of_row = std::vector<int>(result.rows.size(), 0)};
  return RenderPage(result, sweep::Explain(result), evidence);
}

TEST_CASE("The cursor goes through error and speed, and a row without times has no speed") {
  const std::string look = R"(
    const light = row => document.querySelector(`#trials tbody tr[data-row="${row}"]`).cells[0]
      .dispatchEvent(new MouseEvent('mouseover', {bubbles: true}));
    const strips = [...document.querySelectorAll('#paths svg.strip')], seen = [strips.length];
    light(5);
    strips[1].dispatchEvent(new KeyboardEvent('keydown', {key: 'PageUp'}));
    for (const strip of strips) {
      seen.push(strip.getAttribute('aria-valuenow'), strip.getAttribute('aria-valuetext'),
        strip.querySelector('.cursor').getAttribute('visibility'),
        strip.querySelectorAll('.lit polyline').length);
    }
    light(6);
    strips[0].dispatchEvent(new KeyboardEvent('keydown', {key: 'PageUp'}));
    seen.push(strips[1].getAttribute('aria-valuetext'), strips[1].querySelectorAll('.lit polyline').length);
    probe(seen.join('|'));)";
  const BrowserVisit visit = Visit(WithScript(PageWithSpeeds(), WhenDrawn(look)));
  SKIP_WITHOUT_BROWSER(visit);
  // Steps of 1/64 m in 0.1 s (the fifth row) and in 0.05 s (the reference).
  CHECK(Probe(visit) ==
        "PROBE 2|0.10|At 10 % of the way: 0.002 m.|visible|1|"
        "0.10|There at 0.16 m/s, the reference at 0.31 m/s.|visible|2|"
        "no place|0");
  CHECK(visit.console == "");
}

TEST_CASE("One cursor shows a row's error at a place, on the paths and on the strip below them") {
  const std::string look = R"(
    const row = document.querySelector('#trials tbody tr[data-row="5"]');
    row.cells[0].dispatchEvent(new MouseEvent('mouseover', {bubbles: true}));
    const [paths, strip] = document.querySelectorAll('#paths svg'), seen = [];
    const note = () => seen.push(strip.getAttribute('aria-valuenow'),
      strip.getAttribute('aria-valuetext'), paths.querySelectorAll('.cursor circle').length,
      strip.querySelector('.cursor').getAttribute('visibility'));
    const press = key => strip.dispatchEvent(new KeyboardEvent('keydown', {key}));
    for (let i = 0; i < 5; ++i) press('PageUp');
    note();
    press('ArrowLeft'); press('Home'); note();
    // The pointer on the lit path, a quarter of the way along it; then off it.
    const box = paths.getBoundingClientRect();
    const places = paths.querySelector('.lit polyline').getAttribute('points').split(' ');
    const [x, y] = places[(places.length - 1) / 4].split(',').map(Number);
    const point = (x, y) => paths.dispatchEvent(new PointerEvent('pointermove',
      {clientX: box.x + x, clientY: box.y + y}));
    point(x, y); note();
    point(x, y + 90); note();
    seen.push(document.getElementById('paths-lit').textContent);
    probe(seen.join('|'));)";
  const BrowserVisit visit = Visit(WithScript(PageWithPaths(), WhenDrawn(look)));
  SKIP_WITHOUT_BROWSER(visit);
  // Row 5 bulges by 8 mm in its middle, 5.7 mm a quarter of the way.
  CHECK(Probe(visit) ==
        "PROBE 0.50|At 50 % of the way: 0.008 m.|2|visible|"
        "0.00|At 0 % of the way: 0.000 m.|2|visible|"
        "0.25|At 25 % of the way: 0.006 m.|2|visible|"
        "0.25|no place|0|hidden|"
        "Row 5: ice, v_min 0.20, v_max 0.30, trial 1: gap 0.0260 m.");
}

TEST_CASE("Words of the page are explained on hover") {
  const std::string look = R"(probe([...document.querySelectorAll('#sure abbr')]
    .map(word => word.textContent + '=' + word.title).join('|'));)";
  const BrowserVisit visit = Visit(WithScript(PageWithPaths(), WhenDrawn(look)));
  SKIP_WITHOUT_BROWSER(visit);
  CHECK_THAT(Probe(visit), Contains("falsified=shown to fail in more than") &&
                               Contains("undecided=some runs failed"));
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
      const mark = [...document.querySelectorAll('#chart-0 [fill^="rgb"]')].at(-1);
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

struct PageAtWidth {
  std::string page;
  int width_px = 0;
};

/// Each page in a frame of its width, whose style and script see nothing wider; Chromium has no
/// window below 500 px. What a page sends to its parent ends up in the document, with its index.
std::string Framed(const std::vector<PageAtWidth>& pages) {
  std::string html = "<!DOCTYPE html><body style='margin:0'>";
  for (const auto& [page, width_px] : pages) {
    html += "<iframe style='border:0' height=844 width=" + std::to_string(width_px) + " srcdoc=\"" +
            ForAttribute(page) + "\"></iframe>";
  }
  return html +
         "<script>onmessage = e => document.body.append('PROBE ' +"
         "[...document.querySelectorAll('iframe')].findIndex(f => f.contentWindow === e.source)"
         " + ': ' + e.data + ' END');</script></body>";
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
