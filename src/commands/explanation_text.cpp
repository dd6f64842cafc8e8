#include <fmt/format.h>

#include "explanation_output.hpp"
#include "rift/report/text/answers.hpp"

namespace rift::commands {
namespace {

std::string SuggestionsText(const sweep::Explanation& explanation) {
  if (explanation.suggestions.empty()) {
    return "\nno experiment can be suggested: no setting has a gap\n";
  }
  std::string text = "\nnext experiments on the robot, the one that decides most first:\n";
  int number = 0;
  for (const sweep::Suggestion& suggestion : explanation.suggestions) {
    text += fmt::format("{}. {}\n", ++number, suggestion.sentence);
  }
  return text;
}

}  // namespace

std::string ExplanationText(const sweep::SweepResult& result, const sweep::Explanation& explanation,
                            bool suggest) {
  std::string text;
  for (const report::Answer& answer : report::Answers(result, explanation)) {
    const bool is_shown =
        answer.question == "Because of what?" || answer.question == "How sure is that?";
    if (!is_shown) continue;
    text += fmt::format("\n{}\n", answer.question);
    for (const std::string& sentence : answer.sentences) text += fmt::format("- {}\n", sentence);
  }
  return suggest ? text + SuggestionsText(explanation) : text;
}

}  // namespace rift::commands
