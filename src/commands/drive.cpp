#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "drive_output.hpp"
#include "drive_run.hpp"
#include "files.hpp"
#include "keys_flag.hpp"
#include "rift/commands/command.hpp"
#include "rift/hardware/serial_port.hpp"

namespace rift::commands {
namespace {

struct DriveRequest {
  std::string experiment;
  std::vector<std::string> overrides;
  std::string port;
  bool ping = false;
  bool json = false;
};

hardware::HardwareOptions OptionsOf(const DriveRequest& request) {
  if (request.experiment.empty()) return {};
  return config::LoadExperiment(request.experiment, request.overrides,
                                [](const std::string& path) { return ReadFile(path); })
      .hardware;
}

int PingRobot(const DriveRequest& request) {
  const hardware::HardwareOptions options = OptionsOf(request);
  hardware::SerialPort port(request.port, options.line.baud, options.line.write_timeout_s);
  hardware::SteadyClock clock;
  const hardware::PingResult ping = MeasureLink(port, clock, options);
  fmt::print("{}", request.json ? PingJson(ping, options) : PingText(ping, options));
  const bool is_good = ping.IsMeasured() && hardware::BrokenBudget(ping, options.ping).empty();
  return is_good ? kDone : kNotReached;
}

}  // namespace

void AddDrive(CLI::App& app, int& exit_code) {
  const auto request = std::make_shared<DriveRequest>();
  CLI::Option* experiment = app.add_option(
      "EXPERIMENT", request->experiment, "YAML file; its key hardware: holds the link's settings");
  app.add_option("--set", request->overrides, "sets one key, such as hardware.line.baud=115200")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->needs(experiment);
  app.add_option("--port", request->port, "the robot's serial port, such as /dev/rfcomm0")
      ->required()
      ->type_name("TTY");
  app.add_flag("--ping", request->ping, "measure the link with the motors at zero")->required();
  app.add_flag("--json", request->json, "print JSON instead of text");
  AddKeysFlag(app);
  app.footer(
      "Ends with 1 when the link breaks its budget or cannot be measured.\n"
      "Example: rift drive --ping --port /dev/rfcomm0");
  app.callback([request, &exit_code] { exit_code = PingRobot(*request); });
}

}  // namespace rift::commands
