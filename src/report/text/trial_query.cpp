#include "rift/report/text/trial_query.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace rift::report {

namespace {

// The page's own columns: no parameter's name holds a dot.
constexpr std::string_view kRow = ".row", kResult = ".result";

/// Bytes as a browser's URLSearchParams reads them.
std::string QueryText(const std::string& text) {
  static constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.";
  std::string query;
  for (const char c : text) {
    if (kPlain.find(c) != kPlain.npos) {
      query += c;
    } else {
      query += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
  }
  return query;
}

}  // namespace

std::string FailingTrials() { return fmt::format("{}=failed", kResult); }

std::string TrialsWhere(const std::string& parameter, const std::string& value) {
  return QueryText(parameter) + "=" + QueryText(value);
}

std::string TrialsOf(const sweep::SweepResult& result, const experiment::Theta& theta) {
  std::string query;
  for (std::size_t i = 0; i < theta.size(); ++i) {
    query = Both(query, TrialsWhere(result.parameters[i].Name(), theta[i].text));
  }
  return query;
}

std::string TrialsNumbered(const std::vector<int>& rows) {
  constexpr std::size_t kMost = 100;
  std::vector<int> numbers;
  for (std::size_t i = 0; i < std::min(kMost, rows.size()); ++i) numbers.push_back(rows[i] + 1);
  return fmt::format("{}={}", kRow, fmt::join(numbers, "%2C"));
}

std::string Both(const std::string& a, const std::string& b) {
  return a.empty() || b.empty() ? a + b : a + "&" + b;
}

}  // namespace rift::report
