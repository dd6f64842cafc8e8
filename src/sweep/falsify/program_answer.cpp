#include "program_answer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string_view>

#include "rift/statistics/hash.hpp"
#include "rift/trajectory/csv.hpp"
#include "rift/yaml/enum_name.hpp"

namespace rift::sweep {
namespace {

using nlohmann::ordered_json;
using trajectory::csv::Shown;

/// What a persistent program may say of a trial.
constexpr std::array<std::string_view, 6> kAnswers{"ok",         "timed_out", "fell",
                                                   "left_arena", "lost",      "fault"};

}  // namespace

std::string TrialId(ordered_json trial) {
  trial.erase("out");  // its folder is drawn at random
  return statistics::Hash128Text(trial.dump());
}

std::string BreachIn(const ordered_json& answer, const std::string& line, const std::string& id,
                     const std::string& unread) {
  if (!answer.is_object() || !answer.contains("status") || !answer["status"].is_string()) {
    return fmt::format(
        "answered '{}', and a line of JSON with a status is expected, such as {{\"status\": "
        "\"ok\"}}",
        Shown(line));
  }
  const std::string status = answer["status"].get<std::string>();
  if (std::find(kAnswers.begin(), kAnswers.end(), status) == kAnswers.end()) {
    return fmt::format("answered with the status '{}', and it must be one of {}", Shown(status),
                       fmt::join(kAnswers, ", "));
  }
  if (answer.contains("id") && answer["id"] != id) {
    const std::string other =
        answer["id"].dump(-1, ' ', true, ordered_json::error_handler_t::replace);
    return fmt::format(
        "answered with the id {}, and that of its trial is \"{}\": answer each trial once",
        Shown(other), id);
  }
  if (unread.empty()) return "";
  return fmt::format("wrote '{}' to stdout after its answer: answer each trial with one line",
                     Shown(unread));
}

TrialStatus StatusIn(const ordered_json& answer) {
  return yaml::ValueNamed<TrialStatus>(answer["status"].get<std::string>()).value();
}

}  // namespace rift::sweep
