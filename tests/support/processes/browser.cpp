#include "support/processes/browser.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "support/processes/process.hpp"
#include "support/until.hpp"

namespace rift::test {
namespace {

namespace fs = std::filesystem;

std::string Read(const fs::path& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::string LinesWith(const std::string& text, const std::string& word) {
  std::istringstream lines(text);
  std::string kept;
  for (std::string line; std::getline(lines, line);) {
    if (line.find(word) != std::string::npos) kept += line + "\n";
  }
  return kept;
}

/// Addresses in the log of the browser's network stack. Despite all flags Chromium asks for its own
/// updates and the time; those requests come from no document: "not an origin".
std::string Requested(const fs::path& net_log) {
  const nlohmann::json log = nlohmann::json::parse(Read(net_log));
  std::string addresses;
  for (const nlohmann::json& event : log.at("events")) {
    if (!event.contains("params") || !event["params"].contains("initiator")) continue;
    if (event["params"]["initiator"] == "not an origin") continue;
    const std::string url = event["params"].at("url");
    if (url.rfind("http", 0) == 0 || url.rfind("ws", 0) == 0) addresses += url + "\n";
  }
  return addresses;
}

}  // namespace

BrowserVisit Visit(const std::string& html, const std::string& folder_name) {
  BrowserVisit visit;
  visit.available = std::system("command -v chromium >/dev/null 2>&1") == 0;
  if (!visit.available) return visit;
  const TemporaryFolder folder;
  fs::create_directory(folder.Path() / folder_name);
  WriteText(folder.Path() / folder_name / "page.html", html);
  std::string folder_in_url;
  for (const unsigned char byte : folder_name) folder_in_url += fmt::format("%{:02X}", byte);
  const std::string at = folder.Path().string();
  const std::string command =
      "timeout " + std::to_string(kGiveUp.count()) +
      " chromium --headless --no-sandbox --disable-gpu --disable-quic --no-first-run "
      "--disable-background-networking --disable-component-update --disable-sync "
      "--disable-dev-shm-usage --host-resolver-rules='MAP * ~NOTFOUND' --user-data-dir=" +
      at + "/profile --log-net-log=" + at +
      "/net.json --enable-logging=stderr --v=0 --window-size=1280,900 --virtual-time-budget=20000 "
      "--dump-dom file://" +
      at + "/" + folder_in_url + "/page.html >" + at + "/dom.html 2>" + at + "/stderr.txt";
  if (std::system(command.c_str()) != 0) {
    throw std::runtime_error("chromium failed: " + Read(folder.Path() / "stderr.txt"));
  }
  visit.dom = Read(folder.Path() / "dom.html");
  visit.console = LinesWith(Read(folder.Path() / "stderr.txt"), "CONSOLE");
  visit.requests = Requested(folder.Path() / "net.json");
  return visit;
}

}  // namespace rift::test
