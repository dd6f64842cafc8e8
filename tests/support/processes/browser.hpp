#pragma once

#include <string>

namespace rift::test {

/// What headless Chromium made of a page.
struct BrowserVisit {
  bool available = false;  ///< false when there is no Chromium on this machine
  std::string dom;         ///< the document after its scripts ran
  std::string console;     ///< lines logged by the page
  std::string requests;    ///< addresses asked for, other than the page itself and data:
};

/// Opens a page in a fresh profile, without a window; in a folder of that name, of any bytes.
BrowserVisit Visit(const std::string& html, const std::string& folder_name = "page");

}  // namespace rift::test
