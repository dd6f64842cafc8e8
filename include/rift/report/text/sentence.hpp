#pragma once

#include <string>
#include <utility>
#include <vector>

#include "rift/sweep/falsify/result.hpp"

namespace rift::report {

/// A part of a sentence, with the trials it speaks of as a query of the trials table:
/// "surface=ground&result=above%20threshold"; empty for words alone.
struct Piece {
  std::string text;
  std::string query;
};

/// Words of which the numbers lead to their rows.
class Sentence {
 public:
  Sentence() = default;
  Sentence(std::string text) { Say(std::move(text)); }  // NOLINT: a plain sentence is one
  Sentence& Say(std::string text) {
    pieces_.push_back({std::move(text), ""});
    return *this;
  }
  Sentence& Link(std::string text, std::string query) {
    pieces_.push_back({std::move(text), std::move(query)});
    return *this;
  }
  const std::vector<Piece>& pieces() const { return pieces_; }

 private:
  std::vector<Piece> pieces_;
};

/// Queries for the trials table.
std::string AboveThreshold();
std::string TrialsWhere(const std::string& parameter, const std::string& value);
std::string TrialsOf(const sweep::SweepResult& result, const experiment::Theta& theta);
/// By their numbers in table.csv; of many, the first hundred.
std::string TrialsNumbered(const std::vector<int>& rows);
std::string Both(const std::string& a, const std::string& b);

/// Bytes as a browser's URLSearchParams reads them.
std::string QueryText(const std::string& text);

}  // namespace rift::report
