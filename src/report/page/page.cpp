#include "rift/report/page/page.hpp"

#include <fmt/format.h>

#include <kainjow/mustache.hpp>
#include <nlohmann/json.hpp>

#include "embedded.hpp"
#include "parts.hpp"
#include "rift/report/figures/gnuplot_text.hpp"
#include "rift/report/text/findings.hpp"

namespace rift::report {
namespace {

using kainjow::mustache::data;
using kainjow::mustache::mustache;
using nlohmann::json;

// Inside <script>, "</script>" and "<!--" would end or swallow the page; `<` only occurs in
// strings of the JSON, where an escape means the same.
std::string JsonForScript(const json& value) {
  std::string text;
  for (const char c : value.dump(-1, ' ', false, json::error_handler_t::replace)) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

std::string File(std::string_view name) { return std::string(Embedded(name)); }

const char* HeadlineClass(Outcome outcome) {
  if (outcome == Outcome::kFails) return "fail";
  return outcome == Outcome::kHolds ? "pass" : "unknown";
}

data PieceList(const Sentence& sentence) {
  data list{data::type::list};
  for (const Piece& piece : sentence.pieces()) {
    data entry;
    entry.set("text", PlainText(piece.text));
    if (!piece.query.empty()) entry.set("query", piece.query);
    list << entry;
  }
  return list;
}

// What a person reads first; the rest of an answer unfolds, or one screen would not hold them all.
constexpr std::size_t kLeadSentences = 3;

data FindingList(const sweep::SweepResult& result, const sweep::Explanation& explanation) {
  data list{data::type::list};
  for (const Finding& finding : Findings(result, explanation)) {
    data leads{data::type::list}, others{data::type::list};
    for (std::size_t i = 0; i < finding.sentences.size(); ++i) {
      data entry;
      entry.set("pieces", PieceList(finding.sentences[i]));
      (i < kLeadSentences ? leads : others) << entry;
    }
    data entry;
    entry.set("question", finding.question);
    entry.set("sentences", leads);
    entry.set("has_more", finding.sentences.size() > kLeadSentences);
    entry.set("more", others);
    list << entry;
  }
  return list;
}

data SuggestionList(const sweep::Explanation& explanation) {
  data list{data::type::list};
  for (const sweep::Suggestion& suggestion : explanation.suggestions.list) {
    list << data(PlainText(suggestion.sentence));
  }
  return list;
}

data ChartList(const std::vector<PageChart>& charts) {
  data list{data::type::list};
  for (std::size_t i = 0; i < charts.size(); ++i) {
    data entry;
    entry.set("title", PlainText(charts[i].title));
    entry.set("sentence", PlainText(charts[i].sentence));
    entry.set("index", std::to_string(i));
    list << entry;
  }
  return list;
}

// Above that many a list is no longer read, and the table holds them too.
constexpr std::size_t kMostUnmeasuredListed = 500;

void AddUnmeasured(const sweep::SweepResult& result, data* page) {
  std::vector<std::string> lines = UnmeasuredTrials(result);
  page->set("has_unmeasured", !lines.empty());
  page->set("unmeasured_count", std::to_string(lines.size()));
  if (lines.size() > kMostUnmeasuredListed) {
    const std::size_t more = lines.size() - kMostUnmeasuredListed;
    lines.resize(kMostUnmeasuredListed);
    lines.push_back(fmt::format("and {} more, all of them in table.csv", more));
  }
  data list{data::type::list};
  for (const std::string& line : lines) list << data(PlainText(line));
  page->set("unmeasured", list);
}

void AddScripts(const sweep::SweepResult& result, const std::vector<PageChart>& charts,
                const PageEvidence& evidence, const ReportOptions& options, data* page) {
  PageTable settings = SettingsTable(result, options);
  PageTable trials = TrialsTable(result, evidence.gap_flags, options);
  json content = {{"charts", json::array()}};
  for (const PageChart& chart : charts) content["charts"].push_back(chart.spec);
  content["settings"] = std::move(settings.data);
  content["trials"] = std::move(trials.data);
  page->set("charts", ChartList(charts));
  page->set("settings_note", settings.note);
  page->set("trials_note", trials.note);
  page->set("data", JsonForScript(content));
  page->set("css", File("page.css"));
  page->set("vega", File("vega_modules.js") + File("vega.js"));
  page->set("script", File("page.js"));
}

}  // namespace

std::string RenderPage(const sweep::SweepResult& result, const ReportOptions& options) {
  return RenderPage(result, sweep::Explain(result), {}, options);
}

std::string RenderPage(const sweep::SweepResult& result, const sweep::Explanation& explanation,
                       const PageEvidence& evidence, const ReportOptions& options) {
  const Headline headline = Summary(result);
  data page;
  page.set("name", PlainText(result.name));
  page.set("kinds", PlainText(fmt::format("candidate: {}, reference: {}", result.candidate_kind,
                                          result.reference_kind)));
  page.set("headline", PieceList(headline.sentence));
  page.set("headline_class", HeadlineClass(headline.outcome));
  page.set("findings", FindingList(result, explanation));
  page.set("has_suggestions", !explanation.suggestions.list.empty());
  page.set("suggestions", SuggestionList(explanation));
  page.set("definition", gap::DefinitionText(result.gap, result.tag_offset_m));
  page.set("threshold", Number(result.gap.threshold_m));
  AddUnmeasured(result, &page);
  std::vector<PageChart> charts = ProgramCharts(result, evidence.programs);
  for (PageChart& chart : WhyCharts(result, explanation, evidence.failures)) {
    charts.push_back(std::move(chart));
  }
  for (PageChart& chart : PageCharts(result, options)) charts.push_back(std::move(chart));
  AddScripts(result, charts, evidence, options, &page);
  mustache html(File("page.html"));
  std::string text = html.render(page);
  if (!html.is_valid()) throw std::logic_error("page.html: " + html.error_message());
  return text;
}

}  // namespace rift::report
