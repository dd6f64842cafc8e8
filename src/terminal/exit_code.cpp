#include "rift/terminal/exit_code.hpp"

#include <stdexcept>

#include "rift/terminal/print.hpp"
#include "rift/yaml/node.hpp"

namespace rift::terminal {

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
  } catch (const std::exception& error) {
    return Fail(error.what(), kRunTimeFailure);
  }
}

}  // namespace rift::terminal
