#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace rift::simulation {

enum class MotorModel { kDc, kServo };
constexpr std::array<std::string_view, 2> EnumNames(MotorModel) { return {"dc", "servo"}; }

/// The three editions of the 3pi+.
enum class Gearing { k30To1, k75To1, k15To1 };
constexpr std::array<std::string_view, 3> EnumNames(Gearing) { return {"30:1", "75:1", "15:1"}; }

/// What a gearing brings along, at the wheel and at 6 V.
struct GearingData {
  double no_load_rad_s;
  double stall_torque_nm;
  double encoder_counts_per_rev;
};
GearingData DataOf(Gearing gearing);

struct MotorOptions {
  MotorModel model = MotorModel::kDc;
  Gearing gearing = Gearing::k30To1;
  std::optional<double> no_load_rad_s;
  std::optional<double> stall_torque_nm;
  double supply_ratio = 1.0;
  double dead_band = 0.10;
  double lag_s = 0.0;
  double mismatch = 0.0;
  double mismatch_spread = 0.0;
  double friction_torque_nm = 0.0;
  std::optional<double> breakaway_torque_nm;
  double friction_fall_rad_s = 0.0;
  std::optional<double> servo_torque_nm;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field(
        "model", self.model,
        "dc: torque falls with speed, as a brushed motor; servo: holds the asked speed, as in the "
        "authors' Webots world");
    field("gearing", self.gearing,
          "edition of the 3pi+; sets no-load speed, stall torque and encoder counts");
    field("no_load_rad_s", self.no_load_rad_s, 0.1, 1000.0,
          "wheel speed at power 1 without load at the rated voltage, which is that of the data "
          "sheet; "
          "none: that of the gearing (30:1 at 6 V: 75.4 rad/s, Pololu 0J83/5.3)");
    field(
        "stall_torque_nm", self.stall_torque_nm, 1e-4, 10.0,
        "wheel torque at power 1 and standstill at the rated voltage (dc only); none: that of the "
        "gearing (30:1 at 6 V: 0.0324 N m, Pololu 0J83/5.3)");
    field("supply_ratio", self.supply_ratio, 0.05, 3.0,
          "battery voltage as a share of the rated voltage (3pi+: 6 V)");
    field("dead_band", self.dead_band, 0.0, 0.9,
          "powers smaller than this do not turn the wheel (others' code: about 0.10; dc only)");
    field("lag_s", self.lag_s, 0.0, 1.0,
          "time constant of the driver in s, on top of the motor's own inertia (dc only)");
    field("mismatch", self.mismatch, -0.5, 0.5,
          "left wheel faster than the right by this share of the mean at equal power");
    field("mismatch_spread", self.mismatch_spread, 0.0, 0.2,
          "standard deviation of the mismatch from run to run: each run draws its own about "
          "mismatch");
    field("friction_torque_nm", self.friction_torque_nm, 0.0, 10.0,
          "friction of gear and bearing at a turning wheel in N m (dc only; 40 mA without load of "
          "0.67 A at stall, Pololu 0J83/5.3, make 0.0019)");
    field(
        "breakaway_torque_nm", self.breakaway_torque_nm, 0.0, 10.0,
        "friction at a wheel at rest in N m, at least friction_torque_nm; none: the same (dc only; "
        "the robot stands on a ramp of 0.255 rad: more than 0.0031)");
    field("friction_fall_rad_s", self.friction_fall_rad_s, 0.0, 1000.0,
          "wheel speed over which friction falls from that at rest to that of a turning wheel "
          "(Stribeck: as exp(-(speed / this)^2); dc only); 0: as soon as it turns");
    field("servo_torque_nm", self.servo_torque_nm, 1e-3, 100.0,
          "largest torque with which the servo holds its speed in N m (servo only; Dynamixel: its "
          "stall torque); none: any (Webots' 10 is never reached here)");
  }
  /// Rules between fields; throws std::invalid_argument naming field, value and rule.
  void Check() const;

  double NoLoad_rad_s() const { return no_load_rad_s.value_or(DataOf(gearing).no_load_rad_s); }
  double Breakaway_nm() const { return breakaway_torque_nm.value_or(friction_torque_nm); }
  double StallTorque_nm() const {
    return stall_torque_nm.value_or(DataOf(gearing).stall_torque_nm);
  }
};

/// What a motor does to its wheel during one step: the straight line
/// torque = (target - rate) / compliance, never beyond +-limit, and dry friction, which holds a
/// wheel at rest as long as it can. A compliance of zero is a servo.
/// The physics solves the line together with the contacts, at the rate the step ends with: however
/// steep it is and however long the step, it cannot oscillate.
struct WheelDrive {
  double target_rad_s = 0.0;
  double compliance_rad_s_per_nm = 0.0;
  double limit_nm = 0.0;
  double friction_nm = 0.0;
};

/// The power of a motor over one step: at its start, its mean and at its end.
struct StepPower {
  double before = 0.0;
  double mean = 0.0;
  double after = 0.0;

  static StepPower Constant(double power) { return {power, power, power}; }
  /// Share of the step after the change, where the power changes once.
  double ShareAfter() const {
    return after == before ? 1.0 : std::clamp((mean - before) / (after - before), 0.0, 1.0);
  }
};

enum class Side { kLeft, kRight };

/// One motor with its driver. The torque of a brushed motor at 6 V x supply_ratio:
/// torque = stall (power supply - rate / no_load) - friction(rate) sign(rate). A wheel at rest
/// stays so, without creep, while motor and load together turn it with no more than the breakaway
/// torque.
class Motor {
 public:
  Motor(const MotorOptions& options, Side side);

  /// The drive for the next `step_s` seconds; `rate_rad_s` is the wheel's rate now, `drag_nm` what
  /// the ground adds to the friction.
  WheelDrive Drive(const StepPower& power, double rate_rad_s, double drag_nm, double step_s);

 private:
  StepPower ThroughDeadBand(const StepPower& power) const;
  StepPower ThroughLag(const StepPower& power, double step_s);
  double Friction_nm(double rate_rad_s) const;
  double FrictionFromRest_nm(const StepPower& power, double drag_nm) const;

  MotorOptions options_;
  double no_load_rad_s_;  ///< of this side
  double nm_per_rad_s_;   ///< steepness of the torque line
  double lagged_power_ = 0.0;
};

struct EncoderOptions {
  bool reported = true;
  std::optional<double> counts_per_rev;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("reported", self.reported, "whether the robot sends its counts back");
    field("counts_per_rev", self.counts_per_rev, 1.0, 100'000.0,
          "counts for each turn of the wheel; none: 12 x gear ratio (358.3 at 30:1, Pololu "
          "0J86/6.4)");
  }
};

/// The count a quadrature encoder shows once its wheel has turned by `angle_rad` since the start:
/// the last whole edge passed, in either direction.
std::int64_t CountsAt(double angle_rad, double counts_per_rev);

}  // namespace rift::simulation
