// An experiment in YAML; what stands behind a byte 1E is every file that it includes.
#include "fuzz.hpp"
#include "rift/experiment/experiment.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rift;
  std::string_view included = fuzz::TextOf(data, size);
  const std::string file(fuzz::TakeUntil(included, '\x1e'));
  const std::string path = "/fuzz/experiment.yaml";
  std::string written;
  try {
    const experiment::Experiment experiment = experiment::LoadExperiment(
        path, {},
        [&](const std::string& read) { return read == path ? file : std::string(included); });
    written = experiment::WriteExperiment(experiment);
    experiment::FlatValues(experiment);
    experiment::ExperimentAt(experiment, experiment::NominalTheta(experiment));
    experiment::TaskOf(experiment);
  } catch (const yaml::Error& error) {
    fuzz::RequireOneLine(error.what());
  } catch (const std::invalid_argument& error) {
    fuzz::RequireOneLine(error.what());
  }
  if (written.empty()) return 0;
  const experiment::Experiment again =
      experiment::LoadExperiment(path, {}, [&](const std::string&) { return written; });
  fuzz::Require(experiment::WriteExperiment(again) == written, "a saved experiment is itself",
                written);
  return 0;
}
