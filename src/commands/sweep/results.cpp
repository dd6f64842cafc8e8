#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "rift/files/shell_word.hpp"
#include "rift/report/json/json.hpp"
#include "rift/report/text/text.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"
#include "steps.hpp"

namespace rift::commands {

namespace fs = std::filesystem;

std::string GoesOnText(const SweepRequest& request, const std::string& how) {
  return fmt::format("stopped; the same command {}goes on{}",
                     request.fresh ? "without --force (or --fresh) " : "", how);
}

std::string StoppedText(const SweepRequest& request, const experiment::Experiment& experiment,
                        const fs::path& out) {
  // Logs are compared in seconds and keep no journal.
  if (experiment.candidate.kind == experiment::CandidateKind::kLogs) return kStartsOver;
  return GoesOnText(request, fmt::format(" where it was (rift sweep --status {})",
                                         files::ShellWord(out.string())));
}

int SayStopped(const std::string& text) {
  terminal::Say(text);
  return terminal::kStopped;
}

int EndWithoutGap(const SweepRequest& request, const sweep::SweepResult& result) {
  const std::string message =
      fmt::format("{}: not one of {} trials could be compared; the first: {}", request.experiment,
                  result.rows.size(), result.rows.front().reason);
  const auto lacks_log = [](const sweep::TrialRow& row) {
    return row.status == sweep::TrialStatus::kMissing ||
           row.status == sweep::TrialStatus::kUnreadable;
  };
  const bool is_input = std::all_of(result.rows.begin(), result.rows.end(), lacks_log);
  if (is_input || result.candidate_kind == "logs") throw std::invalid_argument(message);
  terminal::Say("rift: " + message);
  return terminal::kNotReached;
}

void PrintFindings(const SweepRequest& request, const sweep::SweepResult& result,
                   const sessions::SweepFindings& findings) {
  if (request.json) return terminal::PrintData(report::SummaryJson(result));
  if (request.brief) {
    return terminal::PrintText(report::BriefText(result, findings.explanation));
  }
  terminal::PrintText(report::SweepText(result));
  if (!findings.likeness.empty()) {
    terminal::PrintText("\n" + report::LikenessText(findings.likeness));
  }
  terminal::PrintText(
      report::ExplanationText(result, findings.explanation, request.suggest.has_value()));
  terminal::PrintText(report::ProgramText(result.parameters, findings.programs));
}

void PrintAnswers(const SweepRequest& request, const fs::path& out,
                  const sweep::SweepResult& result, const sessions::FurtherAnswers& answers) {
  if (request.json || !request.further.Any()) return;
  std::string text;
  if (answers.shrunk) {
    text += report::ShrunkText(result, *answers.shrunk, (out / "shrunk").string());
  }
  if (answers.rare_event) {
    text += fmt::format("\nrare event: {}\n", report::RareEventSentence(*answers.rare_event));
  }
  terminal::PrintText(text);
}

void SayWhere(const SweepRequest& request, const experiment::Experiment& experiment,
              const fs::path& out) {
  if (request.quiet) return;
  if (experiment.candidate.kind != experiment::CandidateKind::kLogs) {
    terminal::Say(fmt::format("worst row again: rift simulate --replay {} worst",
                              files::ShellWord(out.string())));
  }
  terminal::Say("report: " + (out / "report.html").string());
}

int ExitCodeOf(const SweepRequest& request, const sweep::SweepResult& result) {
  if (result.all.n == 0) return terminal::kNotReached;
  const bool may_fail =
      std::any_of(result.settings.begin(), result.settings.end(),
                  [](const sweep::SettingResult& setting) { return setting.verdict.MayFail(); });
  return request.exit_code && may_fail ? terminal::kFalsified : terminal::kDone;
}

}  // namespace rift::commands
