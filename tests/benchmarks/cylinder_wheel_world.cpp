#include "benchmarks/cylinder_wheel_world.hpp"

#include <ode/ode.h>

#include "rift/simulation/ode_world.hpp"

namespace rift::benchmarks {
namespace {

constexpr int kMostContacts = 4;

}  // namespace

struct CylinderWheelWorld::Bodies {
  explicit Bodies(double step);
  ~Bodies();
  void AddWheel(int side);
  void AddCaster();
  void Collide(dGeomID first, dGeomID second);

  simulation::BodyOptions body;
  double step_s;
  dWorldID world;
  dSpaceID space;
  dJointGroupID contacts;
  dBodyID chassis;
  dGeomID floor, chassis_geom, caster_geom;
  std::array<dBodyID, 2> wheels;
  std::array<dJointID, 2> hinges;
};

CylinderWheelWorld::Bodies::Bodies(double step) : step_s(step) {
  dInitODE2(0);
  world = dWorldCreate();
  space = dSimpleSpaceCreate(nullptr);
  contacts = dJointGroupCreate(0);
  dWorldSetGravity(world, 0.0, 0.0, -body.gravity_mps2);
  floor = dCreatePlane(space, 0.0, 0.0, 1.0, 0.0);
  chassis = dBodyCreate(world);
  dMass mass;
  dMassSetCylinderTotal(&mass, body.chassis_mass_kg, 3, body.chassis_radius_m,
                        body.chassis_height_m);
  dBodySetMass(chassis, &mass);
  dBodySetPosition(chassis, body.com_ahead_m, 0.0, body.wheel_radius_m);
  chassis_geom = dCreateCylinder(space, body.chassis_radius_m,
                                 2.0 * (body.wheel_radius_m - body.rim_clearance_m));
  dGeomSetBody(chassis_geom, chassis);
  for (int side = 0; side < 2; ++side) AddWheel(side);
  AddCaster();
}

void CylinderWheelWorld::Bodies::AddWheel(int side) {
  const double y_m = (side == 0 ? 0.5 : -0.5) * body.track_m;
  dMass mass;
  dMassSetCylinderTotal(&mass, body.wheel_mass_kg, 3, body.wheel_radius_m, body.wheel_width_m);
  dMatrix3 lying;
  dRFromAxisAndAngle(lying, 1.0, 0.0, 0.0, M_PI / 2.0);
  wheels[side] = dBodyCreate(world);
  dBodySetMass(wheels[side], &mass);
  dBodySetPosition(wheels[side], 0.0, y_m, body.wheel_radius_m);
  dBodySetRotation(wheels[side], lying);
  dGeomSetBody(dCreateCylinder(space, body.wheel_radius_m, body.wheel_width_m), wheels[side]);
  hinges[side] = dJointCreateHinge(world, nullptr);
  dJointAttach(hinges[side], wheels[side], chassis);
  dJointSetHingeAnchor(hinges[side], 0.0, y_m, body.wheel_radius_m);
  dJointSetHingeAxis(hinges[side], 0.0, 1.0, 0.0);
  dJointSetHingeParam(hinges[side], dParamFMax, dInfinity);
}

void CylinderWheelWorld::Bodies::AddCaster() {
  dMass mass;
  dMassSetSphereTotal(&mass, 0.001, body.caster_radius_m);
  const dBodyID ball = dBodyCreate(world);
  dBodySetMass(ball, &mass);
  dBodySetPosition(ball, body.caster_ahead_m, 0.0, body.wheel_radius_m - body.caster_below_m);
  caster_geom = dCreateSphere(space, body.caster_radius_m);
  dGeomSetBody(caster_geom, ball);
  const dJointID joint = dJointCreateBall(world, nullptr);
  dJointAttach(joint, ball, chassis);
  dJointSetBallAnchor(joint, body.caster_ahead_m, 0.0, body.wheel_radius_m - body.caster_below_m);
}

CylinderWheelWorld::Bodies::~Bodies() {
  dJointGroupDestroy(contacts);
  dSpaceDestroy(space);
  dWorldDestroy(world);
}

void CylinderWheelWorld::Bodies::Collide(dGeomID first, dGeomID second) {
  const dBodyID a = dGeomGetBody(first), b = dGeomGetBody(second);
  if (first != floor && second != floor) return;  // parts of one robot
  std::array<dContact, kMostContacts> made{};
  const int count =
      dCollide(first, second, kMostContacts, &made[0].geom, static_cast<int>(sizeof(dContact)));
  for (int i = 0; i < count; ++i) {
    dSurfaceParameters& surface = made[i].surface;
    surface.mode = dContactApprox1 | dContactSoftERP | dContactSoftCFM;
    const double spring = step_s * body.contact_stiffness_n_per_m;
    surface.soft_erp = spring / (spring + body.contact_damping_ns_per_m);
    surface.soft_cfm = 1.0 / (spring + body.contact_damping_ns_per_m);
    surface.mu = first == caster_geom || second == caster_geom ? 0.0 : 0.8;
    dJointAttach(dJointCreateContact(world, contacts, &made[i]), a, b);
  }
}

CylinderWheelWorld::CylinderWheelWorld(double step_s) : bodies_(std::make_unique<Bodies>(step_s)) {}
CylinderWheelWorld::~CylinderWheelWorld() = default;

void CylinderWheelWorld::Step(const std::array<double, 2>& wheel_rates_rad_s) {
  for (int side = 0; side < 2; ++side) {
    dJointSetHingeParam(bodies_->hinges[side], dParamVel, wheel_rates_rad_s[side]);
  }
  dSpaceCollide(bodies_->space, bodies_.get(), [](void* self, dGeomID first, dGeomID second) {
    static_cast<Bodies*>(self)->Collide(first, second);
  });
  dWorldStep(bodies_->world, bodies_->step_s);
  dJointGroupEmpty(bodies_->contacts);
}

Eigen::Vector2d CylinderWheelWorld::Position_m() const {
  const simulation::BodyOptions& body = bodies_->body;
  dVector3 axle;
  dBodyGetRelPointPos(bodies_->chassis, -body.com_ahead_m, 0.0, 0.0, axle);
  return {axle[0], axle[1]};
}

}  // namespace rift::benchmarks
