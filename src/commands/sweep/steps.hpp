#pragma once

#include <filesystem>
#include <string>

#include "request.hpp"
#include "rift/experiment/experiment.hpp"
#include "rift/sessions/sweep/findings.hpp"
#include "rift/sweep/falsify/result.hpp"
#include "rift/sweep/run/slurm_options.hpp"

// What Sweep() in sweep.cpp does one after the other, as far as it is about the command line.
namespace rift::commands {

/// The experiment that was asked for, budgets included. Throws std::invalid_argument where flags,
/// experiment and the name of the folder do not go together.
experiment::Experiment LoadFor(const SweepRequest& request);

/// Where the files go. Throws std::invalid_argument for the folder of a run, and for one that holds
/// another experiment unless it may be replaced.
std::filesystem::path FolderFor(const SweepRequest& request,
                                const experiment::Experiment& experiment);

/// Fits, judges, writes calibration.json, experiment.yaml, inputs.txt, figures and the robot's
/// file, and prints the table; returns the exit code. With a cluster the fit is made there.
int Calibrate(const SweepRequest& request, const experiment::Experiment& experiment,
              const sweep::SlurmOptions* cluster);

/// Said of what keeps no journal and was stopped.
inline constexpr const char* kStartsOver = "stopped; the same command starts over";

/// That what was stopped goes on: one that was begun afresh by the command without that flag.
std::string GoesOnText(const SweepRequest& request, const std::string& how);

/// How to go on with a sweep that was stopped.
std::string StoppedText(const SweepRequest& request, const experiment::Experiment& experiment,
                        const std::filesystem::path& out);

/// Returns the exit code.
int SayStopped(const std::string& text);

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
