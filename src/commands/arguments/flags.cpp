#include "rift/commands/arguments/flags.hpp"

#include "rift/experiment/experiment.hpp"
#include "rift/terminal/print.hpp"

namespace rift::commands {

CLI::Option* AddSetFlag(CLI::App& app, std::vector<std::string>& overrides, const char* example) {
  return app.add_option("--set", overrides, fmt::format("sets one key, such as {}", example))
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void AddKeysFlag(CLI::App& app) {
  const auto list_and_end = [] {
    terminal::PrintText(experiment::DescribeKeys());
    throw CLI::Success();
  };
  app.add_flag_callback("--keys", list_and_end, "list every key of an experiment and end")
      ->trigger_on_parse();
}

}  // namespace rift::commands
