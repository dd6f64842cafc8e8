#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace rift::yaml {

/// A key as a flag of the command line: "threshold_m" -> "--threshold", its unit "m" for the help.
struct FlagName {
  explicit FlagName(std::string_view key) {
    for (const std::string_view known : {"_m", "_s", "_rad", "_deg", "_hz"}) {
      if (!key.ends_with(known)) continue;
      unit = known.substr(1);
      key.remove_suffix(known.size());
      break;
    }
    flag = "--" + std::string(key);
    std::replace(flag.begin(), flag.end(), '_', '-');
  }

  std::string flag;
  std::string unit;  ///< empty for a pure number
};

}  // namespace rift::yaml
