#pragma once

#include <array>
#include <string_view>

#include "rift/simulation/link.hpp"
#include "rift/simulation/mocap.hpp"
#include "rift/simulation/motor.hpp"
#include "rift/simulation/ode_world.hpp"
#include "rift/simulation/terrain.hpp"

namespace rift::simulation {

/// The power a step sees: the mean of the command over it, or the command at its start.
enum class Sampling { kRamped, kStepped };
constexpr std::array<std::string_view, 2> EnumNames(Sampling) { return {"ramped", "stepped"}; }

/// Everything about the simulated robot but its start and its seed.
struct SimulationOptions {
  double step_s = 0.004;
  Sampling sampling = Sampling::kRamped;
  BodyOptions body;
  MotorOptions motor;
  EncoderOptions encoder;
  LinkOptions link;
  MocapOptions mocap;
  TerrainOptions terrain;

  /// Camera and motors with what the session on the chosen surface has of its own.
  MocapOptions MocapOfSession() const;
  MotorOptions MotorOfSession() const;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("step_s", self.step_s, 0.0001, 0.05,
          "fixed physics step in s (at 0.004, ramped: 0.002 mm with servos on flat ground, "
          "simulation_step_benchmark; 0.5 mm with DC motors that start and stop, 1.4 mm downhill; "
          "over blocks single runs differ, their means do not)");
    field(
        "sampling", self.sampling,
        "ramped: a step sees the mean of the command over it; stepped: that of its start (Webots)");
    field("body", self.body, "masses, sizes and contacts");
    field("motor", self.motor, "both motors");
    field("encoder", self.encoder, "both encoders");
    field("link", self.link, "from the host to the motors");
    field("mocap", self.mocap, "the overhead camera");
    field("terrain", self.terrain, "the ground");
  }
};

}  // namespace rift::simulation
