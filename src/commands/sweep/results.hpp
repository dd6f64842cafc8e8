#pragma once

#include <filesystem>

#include "request.hpp"
#include "rift/experiment/experiment.hpp"
#include "rift/sessions/sweep/findings.hpp"
#include "rift/sessions/sweep/further_questions.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::commands {

/// How to go on with a sweep that was stopped; returns the exit code.
int SayStopped(const experiment::Experiment& experiment, const std::filesystem::path& out);

/// What the process ends with when there is nothing to report on: logs that are not there are bad
/// input (throws std::invalid_argument), a robot that never arrives is a result.
int EndWithoutGap(const SweepRequest& request, const sweep::SweepResult& result);

/// What the trials tell, on stdout: JSON, five lines, or all of it.
void PrintFindings(const SweepRequest& request, const sweep::SweepResult& result,
                   const sessions::SweepFindings& findings);

/// The same of what was asked beyond; as JSON it is in its files alone.
void PrintAnswers(const SweepRequest& request, const std::filesystem::path& out,
                  const sweep::SweepResult& result, const sessions::FurtherAnswers& answers);

/// Where the report is, and how the worst trial is seen again.
void SayWhere(const SweepRequest& request, const experiment::Experiment& experiment,
              const std::filesystem::path& out);

int ExitCodeOf(const SweepRequest& request, const sweep::SweepResult& result);

}  // namespace rift::commands
