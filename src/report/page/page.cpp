#include "rift/report/page/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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

data SentenceList(const std::vector<Sentence>& sentences) {
  data list{data::type::list};
  for (const Sentence& sentence : sentences) {
    data entry;
    entry.set("pieces", PieceList(sentence));
    list << entry;
  }
  return list;
}

/// The answers by the places that they have on the page; of the first three the leading sentence
/// stands on the first screen as well.
void AddFindings(const sweep::SweepResult& result, const sweep::Explanation& explanation,
                 data* page) {
  static constexpr std::array<const char*, 7> kPlaces = {"where",   "because", "sure",   "next",
                                                         "made_of", "noise",   "missing"};
  const std::vector<Finding> findings = Findings(result, explanation);
  for (std::size_t i = 0; i < std::min(findings.size(), kPlaces.size()); ++i) {
    page->set(kPlaces[i], SentenceList(findings[i].sentences));
    if (findings[i].sentences.empty()) continue;
    page->set(std::string(kPlaces[i]) + "_lead", SentenceList({findings[i].sentences.front()}));
  }
}

data SuggestionList(const sweep::Explanation& explanation) {
  data list{data::type::list};
  for (const sweep::Suggestion& suggestion : explanation.suggestions.list) {
    list << data(PlainText(suggestion.sentence));
  }
  return list;
}

/// The charts of the page: those of one section in a list, each with its place in the data.
class ChartPlaces {
 public:
  void Add(const char* section, std::vector<PageChart> charts, data* page) {
    data list{data::type::list};
    for (PageChart& chart : charts) {
      if (chart.spec.is_null()) continue;
      data entry;
      entry.set("title", PlainText(chart.title));
      entry.set("sentence", PlainText(chart.sentence));
      entry.set("index", std::to_string(specs_.size()));
      entry.set("follows", !chart.views.empty());
      list << entry;
      specs_.push_back({{"spec", std::move(chart.spec)},
                        {"fields", std::move(chart.fields)},
                        {"views", std::move(chart.views)}});
    }
    page->set(std::string("has_") + section, !list.is_empty_list());
    page->set(section, list);
  }
  json Take() { return std::move(specs_); }

 private:
  json specs_ = json::array();
};

// Above that many a list is no longer read, and the table holds them too.
constexpr std::size_t kMostUnmeasuredListed = 500;

bool HasPath(const sweep::SweepResult& result) {
  return std::any_of(result.rows.begin(), result.rows.end(),
                     [](const auto& row) { return !row.evidence.path_m.empty(); });
}

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

json Pieces(const Sentence& sentence) {
  json pieces = json::array();
  for (const Piece& piece : sentence.pieces()) pieces.push_back({piece.text, piece.query});
  return pieces;
}

json ViewList(const std::vector<PageView>& views) {
  json list = json::array();
  for (const PageView& view : views) {
    const Headline headline = Summary(*view.part);
    list.push_back({{"query", view.query},
                    {"name", (view.group.empty() ? "" : view.group + " ") + view.label},
                    {"outcome", HeadlineClass(headline.outcome)},
                    {"headline", Pieces(headline.sentence)}});
  }
  return list;
}

/// The choices of the filter, those of one parameter in a group.
data ViewGroups(const std::vector<PageView>& views) {
  data groups{data::type::list};
  for (std::size_t i = 1; i < views.size();) {
    data options{data::type::list}, group;
    const std::string name = views[i].group;
    for (; i < views.size() && views[i].group == name; ++i) {
      data option;
      option.set("index", std::to_string(i));
      option.set("label", PlainText(views[i].label));
      options << option;
    }
    group.set("group", PlainText(name));
    group.set("options", options);
    groups << group;
  }
  return groups;
}

std::string Base64(std::string_view bytes) {
  static constexpr std::string_view kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned long group = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      group = group << 8 | (i + j < bytes.size() ? static_cast<unsigned char>(bytes[i + j]) : 0UL);
    }
    for (std::size_t j = 0; j < 4; ++j) {
      text += i + j > bytes.size() ? '=' : kLetters[group >> (18 - 6 * j) & 63];
    }
  }
  return text;
}

/// As pictures of their own: gnuplot gives the same ids in every file.
data FigureList(const std::vector<PageFigure>& figures) {
  data list{data::type::list};
  for (const PageFigure& figure : figures) {
    data entry;
    entry.set("title", PlainText(figure.title));
    entry.set("svg", Base64(figure.svg));
    list << entry;
  }
  return list;
}

void AddScripts(const sweep::SweepResult& result, const std::vector<PageView>& views,
                ChartPlaces& places, const PageEvidence& evidence, const ReportOptions& options,
                data* page) {
  PageTable settings = SettingsTable(result, options);
  PageTable trials = TrialsTable(result, evidence.gap_flags, options);
  const json content = {{"charts", places.Take()},
                        {"views", ViewList(views)},
                        {"paths", PagePaths(result, evidence, views, options)},
                        {"words", Glossary(result)},
                        {"settings", std::move(settings.data)},
                        {"trials", std::move(trials.data)},
                        {"running", !evidence.running.empty()}};
  page->set("settings_note", settings.note);
  page->set("trials_note", trials.note);
  page->set("data", JsonForScript(content));
  page->set("css", File("page.css"));
  page->set("vega", File("vega_modules.js") + File("vega.js"));
  page->set("script", File("page.js") + File("strips.js") + File("paths.js"));
}

}  // namespace

std::string RenderPage(const sweep::SweepResult& result, const ReportOptions& options) {
  return RenderPage(result, sweep::Explain(result), {}, options);
}

std::string RenderPage(const sweep::SweepResult& result, const sweep::Explanation& explanation,
                       const PageEvidence& evidence, const ReportOptions& options) {
  const Headline headline = Summary(result);
  const std::vector<PageView> views = PageViews(result);
  data page;
  page.set("name", PlainText(result.name));
  page.set("kinds", PlainText(fmt::format("candidate: {}, reference: {}", result.candidate_kind,
                                          result.reference_kind)));
  page.set("say", data(kainjow::mustache::partial([] { return File("pieces.html"); })));
  page.set("headline", SentenceList({headline.sentence}));
  page.set("headline_class", HeadlineClass(headline.outcome));
  page.set("groups", ViewGroups(views));
  page.set("has_groups", views.size() > 1);
  AddFindings(result, explanation, &page);
  page.set("has_suggestions", !explanation.suggestions.list.empty());
  page.set("suggestions", SuggestionList(explanation));
  page.set("definition", gap::DefinitionText(result.gap, result.tag_offset_m));
  page.set("threshold", Number(result.gap.threshold_m));
  page.set("is_running", !evidence.running.empty());
  page.set("running", PlainText(evidence.running));
  page.set("figures", FigureList(evidence.figures));
  page.set("has_figures", !evidence.figures.empty());
  page.set("has_paths", !evidence.references.empty() || HasPath(result));
  AddUnmeasured(result, &page);
  ChartPlaces places;
  const bool has_gap = result.all.n > 0;
  places.Add("map",
             has_gap ? std::vector<PageChart>{FailureMap(result, explanation.region, views)}
                     : std::vector<PageChart>{},
             &page);
  places.Add("why_charts", has_gap ? WhyCharts(explanation) : std::vector<PageChart>{}, &page);
  places.Add(
      "sure_charts",
      has_gap ? std::vector<PageChart>{GapHistogram(result, views)} : std::vector<PageChart>{},
      &page);
  places.Add("program_charts", ProgramCharts(result, evidence.programs), &page);
  AddScripts(result, views, places, evidence, options, &page);
  mustache html(File("page.html"));
  std::string text = html.render(page);
  if (!html.is_valid()) throw std::logic_error("page.html: " + html.error_message());
  return text;
}

}  // namespace rift::report
