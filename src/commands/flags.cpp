#include "flags.hpp"

#include "rift/experiment/experiment.hpp"
#include "rift/terminal/print.hpp"

namespace rift::commands {

void AddKeysFlag(CLI::App& app) {
  const auto list_and_end = [] {
    terminal::PrintText(experiment::DescribeKeys());
    throw CLI::Success();
  };
  app.add_flag_callback("--keys", list_and_end, "list every key of an experiment and end")
      ->trigger_on_parse();
}

}  // namespace rift::commands
