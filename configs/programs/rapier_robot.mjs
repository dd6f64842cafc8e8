// A differential-drive robot of 1 kg in the engine Rapier, for rift sweep:
//   npm install @dimforge/rapier3d-deterministic-compat      (in this folder, or any above it)
// Two driven wheels, a caster without friction, a plane inclined along x; it steers to a goal.
import {createInterface} from 'node:readline';

const PACKAGE = '@dimforge/rapier3d-deterministic-compat';
const RAPIER = await import(PACKAGE).then(module => module.default, error => {
  if (error.code !== 'ERR_MODULE_NOT_FOUND') throw error;
  console.error(`Error: no package ${PACKAGE}: npm install ${PACKAGE} beside rapier_robot.mjs`);
  process.exit(1);
});

await RAPIER.init();
const STEP_S = 0.005, RADIUS_M = 0.033, TRACK_M = 0.16, GOAL = {x: 0.9, y: 0.4};

/// Numbers in [-1, 1] that depend on the seed alone.
const noiseOf = seed => () => {
  seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
  return seed / 2147483648 - 1;
};

function makeRobot(world, friction) {
  const body = (x, y, z) =>
      world.createRigidBody(RAPIER.RigidBodyDesc.dynamic().setTranslation(x, y, z).setCcdEnabled(true));
  const chassis = body(0, 0, RADIUS_M);
  world.createCollider(
      RAPIER.ColliderDesc.cuboid(0.07, 0.06, 0.02).setTranslation(0, 0, 0.02).setMass(0.9), chassis);
  world.createCollider(RAPIER.ColliderDesc.ball(0.012)
                           .setTranslation(-0.06, 0, 0.012 - RADIUS_M)
                           .setMass(0.02)
                           .setFriction(0)
                           .setFrictionCombineRule(RAPIER.CoefficientCombineRule.Min),
                       chassis);
  const wheels = [1, -1].map(side => {
    const wheel = body(0, side * TRACK_M / 2, RADIUS_M);
    world.createCollider(
        RAPIER.ColliderDesc.ball(RADIUS_M).setMass(0.04).setFriction(friction), wheel);
    const axle = RAPIER.JointData.revolute(
        {x: 0, y: side * TRACK_M / 2, z: 0}, {x: 0, y: 0, z: 0}, {x: 0, y: 1, z: 0});
    const joint = world.createImpulseJoint(axle, chassis, wheel, true);
    joint.configureMotorModel(RAPIER.MotorModel.ForceBased);
    return joint;
  });
  return {chassis, wheels};
}

function yawOf(q) {
  return Math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z));
}

function drive({friction, incline, seed}) {
  const slope = incline * Math.PI / 180, noise = noiseOf(seed);
  const world = new RAPIER.World({x: -9.81 * Math.sin(slope), y: 0, z: -9.81 * Math.cos(slope)});
  world.timestep = STEP_S;
  world.createCollider(RAPIER.ColliderDesc.cuboid(5, 5, 0.1).setTranslation(0, 0, -0.1).setFriction(friction));
  const {chassis, wheels} = makeRobot(world, friction);
  let log = 't_s,x_m,y_m,z_m,yaw_rad\n', status = 'timed_out';
  for (let step = 0; step < 15 / STEP_S; ++step) {
    const at = chassis.translation(), yaw = yawOf(chassis.rotation());
    if (step % 10 === 0) {
      log += `${(step * STEP_S).toFixed(3)},${at.x},${at.y},${at.z},${yaw}\n`;
      const error = Math.atan2(GOAL.y - at.y, GOAL.x - at.x) - yaw;
      const turn = 2 * Math.atan2(Math.sin(error), Math.cos(error)) + 0.1 * noise();
      const speeds = [0.2 - turn * TRACK_M / 2, 0.2 + turn * TRACK_M / 2];
      wheels.forEach((wheel, i) => wheel.configureMotorVelocity(speeds[i] / RADIUS_M, 0.05));
    }
    if (at.z < -0.05) { status = 'fell'; break; }
    if (Math.hypot(GOAL.x - at.x, GOAL.y - at.y) < 0.05) { status = 'ok'; break; }
    world.step();
  }
  world.free();
  return {status, log};
}

for await (const line of createInterface({input: process.stdin})) {
  const trial = JSON.parse(line);
  console.log(JSON.stringify({id: trial.id, ...drive({...trial.theta, seed: trial.seed})}));
}
