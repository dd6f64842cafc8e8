// Every number of a comparison beside that of tests/gap/oracle/make.py, which knows the definitions
// and nothing of rift.

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "rift/gap/comparison.hpp"
#include "support/inputs/oracle.hpp"

namespace rift::gap {
namespace {

struct Case {
  GapOptions options;
  std::map<std::string, double> values;
};

std::string Folder() { return test::SourceDir() + "/tests/gap/oracle/"; }

std::map<std::string, Case> Cases() {
  std::map<std::string, Case> cases;
  for (const std::vector<std::string>& cells : test::OracleRows("gap", "values.csv")) {
    REQUIRE(cells.size() == 6);
    const auto &name = cells[0], &samples = cells[1], &skip = cells[2], &align = cells[3],
               &field = cells[4], &value = cells[5];
    Case& one = cases[name];
    one.options.samples = std::stoi(samples);
    one.options.skip_start = std::stod(skip);
    one.options.align = align == "start" ? Align::kStart
                        : align == "se2" ? Align::kSe2
                                         : Align::kNone;
    one.values[field] = value == "null" ? kNotComputed : std::stod(value);
  }
  return cases;
}

std::map<std::string, double> FieldsOf(const Comparison& c) {
  return {{"gap_m", c.gap_m},
          {"u", c.gap_u},
          {"exact_gap_m", c.exact_gap_m},
          {"exact_u", c.exact_gap_u},
          {"mean_error_m", c.mean_error_m},
          {"rms_error_m", c.rms_error_m},
          {"median_error_m", c.median_error_m},
          {"p95_error_m", c.p95_error_m},
          {"mean_yaw_error_rad", c.mean_yaw_error_rad},
          {"max_yaw_error_rad", c.max_yaw_error_rad},
          {"start_offset_m", c.start_offset_m},
          {"end_error_m", c.end_error_m},
          {"start_aligned_gap_m", c.start_aligned_gap_m},
          {"shape_gap_m", c.shape_gap_m},
          {"motion_x_m", c.real_from_sim.x_m},
          {"motion_y_m", c.real_from_sim.y_m},
          {"motion_yaw_rad", c.real_from_sim.yaw_rad},
          {"sim_length_m", c.sim_length_m},
          {"real_length_m", c.real_length_m},
          {"length_ratio", c.length_ratio},
          {"sim_standstill_share", c.sim_standstill_share},
          {"real_standstill_share", c.real_standstill_share},
          {"hausdorff_m", c.hausdorff_m},
          {"frechet_m", c.frechet_m},
          {"dtw_m", c.dtw_m},
          {"equal_time_m", c.equal_time_m}};
}

TEST_CASE("Every number of a comparison is what its definition gives on unequal logs") {
  const std::map<std::string, Case> cases = Cases();
  CHECK(cases.size() == 6);
  for (const auto& [name, one] : cases) {
    const auto load = [&name = name](const std::string& side) {
      return test::LoadTrajectory(Folder() + name + "_" + side + ".csv", trajectory::Format::kRift);
    };
    const auto sim = load("sim"), real = load("real");
    const auto found = FieldsOf(Compare(sim, real, one.options));
    CHECK(found.size() == one.values.size());
    for (const auto& [field, expected] : one.values) {
      INFO(name << ": " << field);
      if (std::isnan(expected)) {
        CHECK(std::isnan(found.at(field)));
      } else {
        CHECK(found.at(field) == Approx(expected).epsilon(1e-8).margin(1e-9));
      }
    }
    CHECK(Gap(sim, real, one.options) == Approx(one.values.at("gap_m")).epsilon(1e-8));
  }
}

}  // namespace
}  // namespace rift::gap
