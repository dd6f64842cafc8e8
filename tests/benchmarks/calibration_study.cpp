// Fits free parameters of the simulated 3pi+ to the authors' trials and prints what
// sweep::Calibrate finds.
//
//   calibration_study [--trial 1|2] [--robot FILE.yaml] [--free KEY=MIN:MAX ...] [--bumps]
//                     [--runs N] [--weight W] [--iterations N] [key=value ...]
//
// A free key starts from the robot's value.

#include <fmt/format.h>

#include "benchmarks/run_study.hpp"
#include "identification/trial_grid.hpp"
#include "rift/config/set_value.hpp"
#include "rift/config/tree.hpp"
#include "rift/config/write.hpp"
#include "rift/sweep/calibration.hpp"

namespace rift {
namespace {

struct Request {
  int trial = 0;
  bool bumps = false;
  std::string robot = test::kAuthorsRobot;
  std::vector<sweep::FreeParameter> free;
  std::vector<std::string> overrides;
  sweep::CalibrationOptions options;
};

sweep::FreeParameter ParseFree(const std::string& text) {
  const size_t equals = text.find('='), colon = text.find(':', equals);
  return {.key = text.substr(0, equals),
          .min = std::stod(text.substr(equals + 1, colon - equals - 1)),
          .max = std::stod(text.substr(colon + 1))};
}

Request ParseArguments(int count, char** arguments) {
  Request request;
  for (int i = 1; i < count; ++i) {
    const std::string argument = arguments[i];
    if (argument == "--bumps") {
      request.bumps = true;
    } else if (argument == "--trial" && i + 1 < count) {
      request.trial = std::stoi(arguments[++i]);
    } else if (argument == "--robot" && i + 1 < count) {
      request.robot = arguments[++i];
    } else if (argument == "--free" && i + 1 < count) {
      request.free.push_back(ParseFree(arguments[++i]));
    } else if (argument == "--runs" && i + 1 < count) {
      request.options.runs = std::stoi(arguments[++i]);
    } else if (argument == "--weight" && i + 1 < count) {
      request.options.likeness_weight = std::stod(arguments[++i]);
    } else if (argument == "--iterations" && i + 1 < count) {
      request.options.iterations = std::stoi(arguments[++i]);
    } else {
      request.overrides.push_back(argument);
    }
  }
  return request;
}

test::GridStudy StudyAt(const test::GridStudy& study, const std::vector<sweep::FreeParameter>& free,
                        const std::vector<double>& values) {
  std::vector<config::KeyValue> pairs;
  for (size_t i = 0; i < free.size(); ++i) {
    pairs.push_back({free[i].key, config::Node::Scalar(fmt::format("{}", values[i]))});
  }
  test::GridStudy at = study;
  config::SetValues(at, pairs);
  return at;
}

/// The value a key has now: the resolved experiment says it.
double ValueOf(const test::GridStudy& study, const std::string& key) {
  config::Node node = config::ToNode(study);
  const config::Node* at = &node;
  for (size_t from = 0; from < key.size();) {
    const size_t dot = std::min(key.find('.', from), key.size());
    at = &const_cast<config::Node*>(at)->Find(key.substr(from, dot - from))->value;
    from = dot + 1;
  }
  return std::stod(at->text);
}

void Print(const sweep::Calibration& found) {
  fmt::print("loss {:.4f} -> {:.4f} in {} steps{}, {} trials simulated\n", found.loss_before,
             found.loss_after, found.steps, found.has_converged ? "" : " (not converged)",
             found.trials_simulated);
  for (const sweep::CalibratedParameter& p : found.parameters) {
    fmt::print("  {:<52} {:>9.5f} [{:.5f}, {:.5f}] from {:.5f}{}{}{}\n", p.parameter.key, p.value,
               p.low, p.high, p.parameter.start, p.has_effect ? "" : " no effect",
               p.is_at_bound ? " at its bound" : "", p.is_identified ? "" : " not identified");
  }
  for (Eigen::Index a = 0; a < found.correlation.rows(); ++a) {
    for (Eigen::Index b = 0; b < a; ++b) {
      if (std::abs(found.correlation(a, b)) < 0.5) continue;
      fmt::print("  correlation {:+.2f}: {} and {}\n", found.correlation(a, b),
                 found.parameters[a].parameter.key, found.parameters[b].parameter.key);
    }
  }
}

int Study(Request request) {
  const test::GridStudy study = test::LoadGridStudy(request.robot, request.overrides);
  std::vector<test::GridTrial> trials;
  for (test::GridTrial& trial : test::LoadTrialGrid(study, request.trial)) {
    if ((trial.surface == "bump") == request.bumps) trials.push_back(std::move(trial));
  }
  std::vector<sweep::CalibrationLog> logs;
  for (const test::GridTrial& trial : trials) {
    logs.push_back({trial.setting, trial.setting, trial.real});
  }
  for (sweep::FreeParameter& free : request.free) free.start = ValueOf(study, free.key);
  std::mt19937_64 generator(1);
  Print(sweep::Calibrate(
      request.free, logs,
      [&](size_t log, const std::vector<double>& values) {
        return test::TwinOf(StudyAt(study, request.free, values), trials[log],
                            1 + 1000 * static_cast<std::uint64_t>(log));
      },
      request.options, generator, 2));
  return 0;
}

}  // namespace
}  // namespace rift

int main(int count, char** arguments) {
  return rift::test::RunStudy([&] { return rift::Study(rift::ParseArguments(count, arguments)); });
}
