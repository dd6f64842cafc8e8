#include "rift/terminal/exit_code.hpp"

#include <filesystem>
#include <stdexcept>

#include "rift/terminal/print.hpp"
#include "rift/yaml/node.hpp"

namespace rift::terminal {

namespace {

/// The library's own text begins with "filesystem error" and the name of a function.
std::string TextOf(const std::filesystem::filesystem_error& error) {
  const std::string reason = error.code().message();
  return error.path1().empty() ? reason : "cannot use " + error.path1().string() + ": " + reason;
}

}  // namespace

int Fail(const std::string& what, int exit_code) {
  Say("rift: " + what);
  return exit_code;
}

int ReportErrors(const std::function<int()>& work) {
  try {
    return work();
  } catch (const std::invalid_argument& error) {
    return Fail(error.what(), kBadInput);
  } catch (const yaml::Error& error) {
    return Fail(error.what(), kBadInput);
  } catch (const std::filesystem::filesystem_error& error) {
    return Fail(TextOf(error), kRunTimeFailure);
  } catch (const std::exception& error) {
    return Fail(error.what(), kRunTimeFailure);
  }
}

}  // namespace rift::terminal
