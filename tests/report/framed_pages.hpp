#pragma once

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "report/synthetic_sweep.hpp"
#include "rift/sweep/falsify/evidence.hpp"
#include "support/processes/browser.hpp"

#define SKIP_WITHOUT_BROWSER(visit)                        \
  if (!(visit).available) {                                \
    WARN("SKIPPED: there is no chromium on this machine"); \
    return;                                                \
  }

namespace rift::report {

inline std::string WithScript(std::string page, const std::string& script) {
  const std::size_t end = page.rfind("</body>");
  return page.insert(end, "<script>" + script + "</script>");
}

/// The text from `begin` to END that a script put into the document.
inline std::string Probe(const test::BrowserVisit& visit, const std::string& begin = "PROBE ") {
  const std::size_t at = visit.dom.rfind(begin);
  if (at == std::string::npos) return "no probe: " + visit.console;
  return visit.dom.substr(at, visit.dom.find(" END", at) - at);
}

inline std::string ForAttribute(const std::string& html) {
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
inline std::string Framed(const std::vector<PageAtWidth>& pages) {
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

inline sweep::SweepResult GridWithPaths() {
  sweep::SweepResult result = synthetic::Grid();
  for (std::size_t i = 0; i < result.rows.size(); ++i) {
    if (!result.rows[i].IsOk()) continue;
    result.rows[i].evidence.path_m =
        sweep::EvenPath(synthetic::Path(0.002 * static_cast<double>(i)), {});
  }
  return result;
}

}  // namespace rift::report
