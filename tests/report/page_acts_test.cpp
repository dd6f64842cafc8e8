// What a reader does with a page: filters, links, the pointer, keys.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "report/framed_pages.hpp"
#include "report/uneven_sweep.hpp"
#include "rift/report/page/page.hpp"
#include "rift/sweep/explain/explanation.hpp"

namespace rift::report {
namespace {

using Catch::Matchers::Contains;
using test::BrowserVisit;

std::string WhenDrawn(const std::string& script) {
  return "const probe = text => parent.postMessage(text, '*');"
         "const wait = () => document.body.dataset.drawn ? setTimeout(() => {" +
         script + "}, 100) : setTimeout(wait, 50); wait();";
}

std::string PageWithPaths() {
  const sweep::SweepResult result = GridWithPaths();
  PageEvidence evidence{
      .references = {{"robot, trial 1", sweep::EvenPath(synthetic::Path(0.0), {})}},
      .reference_of_row = std::vector<int>(result.rows.size(), 0)};
  return RenderPage(result, sweep::Explain(result), evidence);
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

constexpr const char* kFilter = R"(
    const choice = document.getElementById('view');
    choice.value = [...choice.options].findIndex(option => option.textContent === 'rock');
    choice.dispatchEvent(new Event('change'));
    setTimeout(() => probe([document.getElementById('headline').textContent,
      document.querySelectorAll('#settings tbody tr').length,
      document.querySelectorAll('#trials tbody tr').length,
      document.querySelectorAll('#paths svg:not(.strip) .other').length,
      document.querySelectorAll('#chart-0 [fill^="rgb"]').length].join('|')), 300);)";

constexpr const char* kFollowLinks = R"(
    const seen = [], links = ['.result=failed', 'surface=parchment&.result=failed',
      '.row=3%2C5%2C8', 'surface=ground', '.result=fell', 'v_min=0.25&surface=parchment&delay_s=0.02'];
    const next = () => {
      if (seen.length === links.length) { probe(seen.join('|')); return; }
      location.hash = '#trials?' + links[seen.length];
      setTimeout(() => {
        seen.push([...document.querySelectorAll('#trials tbody tr')].length);
        next();
      }, 50);
    };
    next();)";

/// Parameters called as columns of the page, with values that its links know.
std::string PageOfRows() {
  sweep::SweepResult result = synthetic::Grid({"failed", "a\tb", "rock"});
  result.parameters[0].key = "result";
  result.parameters[1].key = "row";
  return RenderPage(result);
}

constexpr const char* kFollowOwnNames = R"(
    const seen = [], rows = () => document.querySelectorAll('#trials tbody tr').length;
    const choice = document.getElementById('view');
    for (const name of ['failed', 'a\tb', '0.15']) {
      showView(page.views.findIndex(view => view.name.endsWith(' ' + name)));
      seen.push(rows());
    }
    showView(0);
    const links = ['result=failed', '.result=failed', 'result=failed&.result=failed',
      'row=0.15', '.row=3', 'row=0.15&.row=3%2C5'];
    const next = () => {
      if (links.length === 0) {
        probe(seen.join('|') + '|' + document.querySelector('#filter span').textContent);
        return;
      }
      location.hash = '#trials?' + links.shift();
      setTimeout(() => { seen.push(rows()); next(); }, 50);
    };
    next();)";

constexpr const char* kPointAtRow = R"(
    const row = document.querySelector('#trials tbody tr[data-row="5"]');
    const seen = [];
    const note = () => seen.push(document.querySelectorAll('#paths svg:not(.strip) .lit polyline').length,
      document.getElementById('paths-lit').textContent);
    row.cells[0].dispatchEvent(new MouseEvent('mouseover', {bubbles: true})); note();
    row.closest('table').dispatchEvent(new MouseEvent('mouseleave')); note();
    row.querySelector('button').focus(); note();
    probe(seen.join('|'));)";

constexpr const char* kMoveCursor = R"(
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

constexpr const char* kFollowPath = R"(
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

constexpr const char* kHover = R"(probe([...document.querySelectorAll('#sure abbr')]
    .map(word => word.textContent + '=' + word.title).join('|'));)";

constexpr const char* kSort = R"(
    const heading = [...document.querySelectorAll('#trials th')]
      .find(th => th.textContent === 'gap (m)');
    const column = heading.cellIndex, seen = [];
    const look = () => seen.push(heading.getAttribute('aria-sort'),
      document.querySelector('#trials tbody tr').cells[column].textContent,
      document.querySelector('#trials tbody tr:last-child').cells[column].textContent);
    look();
    heading.querySelector('button').click(); look();
    heading.querySelector('button').click(); look();
    probe(seen.join('|'));)";

constexpr const char* kCompare = R"(
    const cells = ['word', '10', '0.5', '-0.03', '', '0.15', '-0.06', '9', '0.0123', '1e-3'];
    probe(cells.sort(compare).join('|'));)";

constexpr const char* kTouchMark = R"(
    setTimeout(() => {
      const mark = [...document.querySelectorAll('#chart-0 [fill^="rgb"]')].at(-1);
      const box = mark.getBoundingClientRect();
      mark.dispatchEvent(new MouseEvent('mousemove', {bubbles: true,
        clientX: box.x + box.width / 2, clientY: box.y + box.height / 2}));
      mark.dispatchEvent(new MouseEvent('mouseover', {bubbles: true,
        clientX: box.x + box.width / 2, clientY: box.y + box.height / 2}));
      setTimeout(() => probe(tip.hidden + ' ' + tip.innerHTML), 200);
    }, 1000);)";

/// A page and what a reader does with it, a script that ends in probe(what is seen then).
struct Act {
  std::string page;
  const char* script;
};

const std::vector<Act>& Acts() {
  static const std::vector<Act> kActs{
      {PageWithPaths(), kFilter},
      {RenderPage(synthetic::Uneven()), kFollowLinks},
      {PageOfRows(), kFollowOwnNames},
      {PageWithPaths(), kPointAtRow},
      {PageWithSpeeds(), kMoveCursor},
      {PageWithPaths(), kFollowPath},
      {PageWithPaths(), kHover},
      {RenderPage(synthetic::Grid()), kSort},
      {RenderPage(synthetic::Grid()), kCompare},
      {RenderPage(synthetic::Grid({"ice", "snow", "<b>rock"})), kTouchMark}};
  return kActs;
}

/// All of them in one visit, since a start of the browser costs as much as two pages.
const BrowserVisit& VisitAsReader() {
  static const BrowserVisit kVisit = [] {
    std::vector<PageAtWidth> pages;
    for (const Act& act : Acts()) {
      pages.push_back({WithScript(act.page, WhenDrawn(act.script)), 1280});
    }
    return test::Visit(Framed(pages));
  }();
  return kVisit;
}

std::string SeenAfter(const char* script) {
  const auto act = std::find_if(Acts().begin(), Acts().end(),
                                [script](const Act& one) { return one.script == script; });
  const std::string begin = "PROBE " + std::to_string(act - Acts().begin()) + ": ";
  const std::string seen = Probe(VisitAsReader(), begin);
  return seen.starts_with(begin) ? seen.substr(begin.size()) : seen;
}

TEST_CASE("What a reader does with the page shows what it says") {
  SKIP_WITHOUT_BROWSER(VisitAsReader());
  CHECK(VisitAsReader().console == "");
  SECTION("Sentence, tables, paths and charts follow the filter") {
    const std::string seen = SeenAfter(kFilter);
    CHECK_THAT(seen, Contains("surface rock: ") && Contains("It fails: 8 of 8 measured trials"));
    // 4 settings, 8 trials, of which one is the worst and no other line; 2 cells of rock are left.
    CHECK_THAT(seen, Contains("|4|8|7|2"));
  }
  SECTION("Links of the page show the rows that they count, fallen robots included") {
    const sweep::SweepResult result = synthetic::Uneven();
    long failed = 0, on_parchment = 0, on_ground = 0;
    for (const sweep::TrialRow& row : result.rows) {
      failed += row.falsified ? 1 : 0;
      on_parchment += row.falsified && row.theta[1].text == "parchment" ? 1 : 0;
      on_ground += row.theta[1].text == "ground" ? 1 : 0;
    }
    CHECK(SeenAfter(kFollowLinks) ==
          fmt::format("{}|{}|3|{}|1|3", failed, on_parchment, on_ground));
  }
  SECTION("Parameters called row or result are not taken for the page's own columns") {
    // Eight trials of each result and twelve of each row; rows 3 and 4 are of row 0.15, 5 is not.
    CHECK(SeenAfter(kFollowOwnNames) ==
          "8|8|12|8|8|0|12|1|1|1 of the 24 trials on this page have row 0.15 and row 3, 5.");
  }
  SECTION("The pointer and the focus on a row light its path and say what it is") {
    const std::string row = "Row 5: ice, v_min 0.20, v_max 0.30, trial 1: gap 0.0260 m.";
    CHECK_THAT(SeenAfter(kPointAtRow),
               Contains("2|" + row + "|0|Worst: row") && Contains("|2|" + row));
  }
  SECTION("The cursor goes through error and speed, and a row without times has no speed") {
    // Steps of 1/64 m in 0.1 s (the fifth row) and in 0.05 s (the reference).
    CHECK(SeenAfter(kMoveCursor) ==
          "2|0.10|At 10 % of the way: 0.002 m.|visible|1|"
          "0.10|There at 0.16 m/s, the reference at 0.31 m/s.|visible|2|"
          "no place|0");
  }
  SECTION("One cursor shows a row's error at a place, on the paths and on the strip below them") {
    // Row 5 bulges by 8 mm in its middle, 5.7 mm a quarter of the way.
    CHECK(SeenAfter(kFollowPath) ==
          "0.50|At 50 % of the way: 0.008 m.|2|visible|"
          "0.00|At 0 % of the way: 0.000 m.|2|visible|"
          "0.25|At 25 % of the way: 0.006 m.|2|visible|"
          "0.25|no place|0|hidden|"
          "Row 5: ice, v_min 0.20, v_max 0.30, trial 1: gap 0.0260 m.");
  }
  SECTION("Words of the page are explained on hover") {
    CHECK_THAT(SeenAfter(kHover), Contains("falsified=shown to fail in more than") &&
                                      Contains("undecided=some runs failed"));
  }
  SECTION("A click on a heading sorts the table and a second one turns it round") {
    // The trial without a gap stays last either way.
    CHECK(SeenAfter(kSort) == "none|0.0260|0.0740|ascending|0.0260|–|descending|0.0740|–");
  }
  SECTION("Cells that are numbers sort by their value before words and the empty cell") {
    CHECK(SeenAfter(kCompare) == "-0.06|-0.03|1e-3|0.0123|0.15|0.5|9|10||word");
  }
  SECTION("Tooltips show what a mark stands for as plain text") {
    CHECK_THAT(SeenAfter(kTouchMark),
               Contains("false") && Contains("surface: ") && Contains("&amp;lt;b&amp;gt;rock"));
  }
}

}  // namespace
}  // namespace rift::report
