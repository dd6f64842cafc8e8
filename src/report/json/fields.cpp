#include "rift/report/json/fields.hpp"

namespace rift::report {

std::string Dump(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

nlohmann::ordered_json ThetaJson(const std::vector<experiment::Parameter>& parameters,
                                 const experiment::Theta& theta) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (size_t i = 0; i < theta.size(); ++i) {
    nlohmann::ordered_json& value = json[parameters[i].Name()];
    if (theta[i].number) {
      value = *theta[i].number;
    } else {
      value = theta[i].text;
    }
  }
  return json;
}

}  // namespace rift::report
