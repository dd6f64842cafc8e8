#include "rift/report/text/answers.hpp"

#include "rift/report/text/findings.hpp"

namespace rift::report {

std::vector<Answer> Answers(const sweep::SweepResult& result,
                            const sweep::Explanation& explanation) {
  std::vector<Answer> answers;
  for (const Finding& finding : Findings(result, explanation)) {
    Answer answer{finding.question, {}};
    for (const Sentence& sentence : finding.sentences) {
      std::string text;
      for (const Piece& piece : sentence.pieces()) text += piece.text;
      answer.sentences.push_back(std::move(text));
    }
    answers.push_back(std::move(answer));
  }
  return answers;
}

}  // namespace rift::report
