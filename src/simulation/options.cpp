#include "rift/simulation/options.hpp"

namespace rift::simulation {

MocapOptions SimulationOptions::MocapOfSession() const {
  const SurfaceOptions& surface = terrain.Chosen();
  MocapOptions session = mocap;
  // A host that is none stays none: rift drive is another than that of the logs.
  if (session.host_period_s && surface.host_period_s) session.host_period_s = surface.host_period_s;
  session.ambiguity.share *= surface.mirrored_share;
  session.ambiguity.runs *= surface.mirrored_runs;
  for (double MocapOptions::*scatter :
       {&MocapOptions::noise_across_m, &MocapOptions::blur_across_s, &MocapOptions::noise_along_m,
        &MocapOptions::noise_yaw_rad, &MocapOptions::blur_yaw_rad_per_mps, &MocapOptions::noise_z_m,
        &MocapOptions::noise_tilt_rad}) {
    session.*scatter *= surface.tracker_noise;
  }
  return session;
}

MotorOptions SimulationOptions::MotorOfSession() const {
  MotorOptions session = motor;
  session.mismatch += terrain.Chosen().session_mismatch;
  return session;
}

}  // namespace rift::simulation
