#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "support/processes/environment.hpp"
#include "support/processes/process.hpp"

namespace rift::test {

/// A gnuplot whose drawings are the scripts it was given: they differ where figures would, and cost
/// a tenth of the time. For the processes that are started in its scope.
class QuickGnuplot {
 public:
  QuickGnuplot() {
    WriteText(folder_ / "end", "</svg>IEND");
    WriteText(folder_ / "gnuplot", "#!/bin/sh\nexec cat - '" + folder_ / "end" + "'\n");
    std::filesystem::permissions(folder_ / "gnuplot", std::filesystem::perms::owner_all);
  }

 private:
  TemporaryFolder folder_;
  const char* usual_ = std::getenv("PATH");
  Environment path_{"PATH", folder_.Path().string() + ":" + (usual_ == nullptr ? "" : usual_)};
};

}  // namespace rift::test
