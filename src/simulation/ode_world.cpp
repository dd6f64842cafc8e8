#include "rift/simulation/ode_world.hpp"

#include <fmt/format.h>
#include <ode/ode.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "contacts.hpp"

// The only file that knows ODE.
namespace rift::simulation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kWorldErp = 0.8;
constexpr double kMaxCorrection_mps = 0.5;
constexpr double kSettle_s = 0.4;
constexpr int kMostDrops = 6;
constexpr double kStartOff_m = 1e-4;    // from where the robot is asked to start
constexpr double kStartOff_rad = 1e-3;  // and turned from its heading
/// Both wheels hold the same sideways freedom; this much give keeps the two solvable, and lets the
/// robot creep by less than a micrometre a second on a slope.
constexpr double kLeastSlip_mps_per_n = 1e-6;
constexpr double kSameNormal = 0.95;  // cosine of the angle between two
constexpr double kFaster_mps = 0.15;  // than the robot, a part that tips or falls

/// Thrown by ODE's own error reports, which must not return; caught at every call that can raise
/// it.
struct OdeFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

void ThrowFailure(int number, const char* message, va_list arguments) {
  char text[256];
  std::vsnprintf(text, sizeof text, message, arguments);
  throw OdeFailure(fmt::format("ODE reports error {}: {}", number, text));
}

/// ODE's notes (a pivot of the contact solver that found no answer) cost accuracy, not the run:
/// what they could lead to is caught by looking at the state.
void IgnoreNote(int, const char*, va_list) {}

/// ODE's process-wide set-up, made once; its error handlers would otherwise end the process.
void SetUpOde() {
  static const bool done = [] {
    dSetErrorHandler(ThrowFailure);
    dSetDebugHandler(ThrowFailure);
    dSetMessageHandler(IgnoreNote);
    dInitODE2(0);
    return true;
  }();
  static_cast<void>(done);
}

struct Deleter {
  void operator()(dxWorld* world) const { dWorldDestroy(world); }
  void operator()(dxJointGroup* group) const { dJointGroupDestroy(group); }
  void operator()(dxThreadingImplementation* threading) const {
    dThreadingFreeImplementation(threading);
  }
};

Vector3d Vector(const dReal* values) { return Eigen::Map<const Vector3d>(values); }

Matrix3d Rotation(dBodyID body) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(dBodyGetRotation(body))
      .leftCols<3>();
}

void SetRotation(dBodyID body, const Matrix3d& rotation) {
  dMatrix3 rows{};
  Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(rows).leftCols<3>() = rotation;
  dBodySetRotation(body, rows);
}

void SetPosition(dBodyID body, const Vector3d& p) { dBodySetPosition(body, p.x(), p.y(), p.z()); }

}  // namespace

/// Contacts of one part with the ground, with the forces that the last step needed.
struct PartContacts {
  dBodyID part = nullptr;
  std::vector<Vector3d> normals;
  std::vector<dJointFeedback> forces;  ///< on the part, filled by the step

  /// Load of the last step's contact with about this normal; none for one that is new.
  std::optional<double> LastLoad_n(const Vector3d& normal) const {
    for (size_t i = 0; i < normals.size(); ++i) {
      if (normals[i].dot(normal) > kSameNormal)
        return std::max(0.0, Vector(forces[i].f1).dot(normal));
    }
    return std::nullopt;
  }
};

struct OdeWorld::Bodies {
  Bodies(const BodyOptions& body_options, const Terrain& ground, double step);

  void AddBodies();
  void Place(const geometry::Pose2& start);
  void PlaceByDropping(const geometry::Pose2& start);
  void PlaceOn(const Plane& plane, double yaw_rad);
  Plane PlaneUnder(const geometry::Pose2& robot) const;
  void Settle();

  void Step(const std::array<WheelDrive, 2>& drives, const std::array<double, 2>& uneven = {});
  void Abandon();
  void SetDrive(int side, const WheelDrive& drive);
  void MakeContacts(const std::array<double, 2>& uneven);
  void Add(PartContacts& part, bool sticks);
  dContact ContactOf(const GroundContact& ground, std::optional<double> load_n) const;
  void ReadState();

  BodyOptions body;
  Terrain terrain;
  double step_s;
  std::unique_ptr<dxThreadingImplementation, Deleter> threading;
  std::unique_ptr<dxWorld, Deleter> world;
  std::unique_ptr<dxJointGroup, Deleter> contacts;
  dBodyID chassis = nullptr;
  std::array<dBodyID, 2> wheels{};
  std::array<dJointID, 2> hinges{};
  std::array<dJointID, 2> frictions{};  ///< hold a wheel against the chassis
  double contact_erp, contact_cfm;
  std::vector<GroundContact> found;
  std::array<PartContacts, 2> wheel_contacts;
  PartContacts caster_contacts, rim_contacts;
  bool settling = false;
  WorldState state;
  std::optional<std::string> fault, fall;
};

OdeWorld::Bodies::Bodies(const BodyOptions& body_options, const Terrain& ground, double step)
    : body(body_options), terrain(ground), step_s(step) {
  SetUpOde();
  // With ODE's shared default two worlds stepped in two threads abort the process.
  threading.reset(dThreadingAllocateSelfThreadedImplementation());
  world.reset(dWorldCreate());
  dWorldSetStepThreadingImplementation(
      world.get(), dThreadingImplementationGetFunctions(threading.get()), threading.get());
  contacts.reset(dJointGroupCreate(0));
  dWorldSetGravity(world.get(), 0.0, 0.0, -body.gravity_mps2);
  dWorldSetERP(world.get(), kWorldErp);
  dWorldSetContactMaxCorrectingVel(world.get(), kMaxCorrection_mps);
  // A spring and damper as ODE wants them [ODE manual, "How to use ERP and CFM"].
  const double spring = step_s * body.contact_stiffness_n_per_m;
  contact_erp = spring / (spring + body.contact_damping_ns_per_m);
  contact_cfm = 1.0 / (spring + body.contact_damping_ns_per_m);
  AddBodies();
}

void OdeWorld::Bodies::AddBodies() {
  dMass mass;
  chassis = dBodyCreate(world.get());
  dMassSetCylinderTotal(&mass, body.chassis_mass_kg, 3, body.chassis_radius_m,
                        body.chassis_height_m);
  dBodySetMass(chassis, &mass);
  dBodySetFiniteRotationMode(chassis, 1);
  SetPosition(chassis, {body.com_ahead_m, 0.0, body.com_above_m});
  dMassSetCylinderTotal(&mass, body.wheel_mass_kg, 2, body.wheel_radius_m, body.wheel_width_m);
  for (int side = 0; side < 2; ++side) {
    wheels[side] = dBodyCreate(world.get());
    dBodySetMass(wheels[side], &mass);
    dBodySetFiniteRotationMode(wheels[side], 1);
    SetPosition(wheels[side], {0.0, (side == 0 ? 0.5 : -0.5) * body.track_m, 0.0});
    hinges[side] = dJointCreateHinge(world.get(), nullptr);
    dJointAttach(hinges[side], wheels[side], chassis);
    const Vector3d anchor = Vector(dBodyGetPosition(wheels[side]));
    dJointSetHingeAnchor(hinges[side], anchor.x(), anchor.y(), anchor.z());
    dJointSetHingeAxis(hinges[side], 0.0, 1.0, 0.0);
    frictions[side] = dJointCreateAMotor(world.get(), nullptr);
    dJointAttach(frictions[side], wheels[side], chassis);
    dJointSetAMotorNumAxes(frictions[side], 1);
    dJointSetAMotorAxis(frictions[side], 0, 2, 0.0, 1.0, 0.0);
    dJointSetAMotorParam(frictions[side], dParamVel, 0.0);
    wheel_contacts[side].part = wheels[side];
  }
  caster_contacts.part = rim_contacts.part = chassis;
}

void OdeWorld::Bodies::Place(const geometry::Pose2& start) {
  const double reach_m = 1.5 * body.chassis_radius_m;
  const auto plane = terrain.PlaneNear(start.x_m, start.y_m, reach_m);
  const Vector3d ground(start.x_m, start.y_m, terrain.HeightAt(start.x_m, start.y_m));
  if (!std::isfinite(ground.z())) {
    throw std::invalid_argument(
        fmt::format("the robot cannot start at ({:.3f}, {:.3f}) m, beyond the edge of the table",
                    ground.x(), ground.y()));
  }
  if (plane) {
    PlaceOn(*plane, start.yaw_rad);
  } else {
    PlaceByDropping(start);
  }
}

/// On ground that is no plane. Where it is smooth, a robot that slid as it came to rest is put so
/// much to the other side and dropped again. On blocks it stays where it slid off an edge.
void OdeWorld::Bodies::PlaceByDropping(const geometry::Pose2& start) {
  geometry::Pose2 aim = start;
  for (int drop = 0; drop < kMostDrops; ++drop) {
    PlaceOn(PlaneUnder(aim), aim.yaw_rad);
    Settle();
    const Matrix3d& turned = state.world_from_robot;
    const Eigen::Vector2d off_m = start.Position() - state.position_m.head<2>();
    const double off_rad =
        geometry::WrapToPi(start.yaw_rad - std::atan2(turned(1, 0), turned(0, 0)));
    const bool is_there = off_m.norm() < kStartOff_m && std::abs(off_rad) < kStartOff_rad;
    if (is_there || fault || terrain.IsStepped()) return;
    aim = {aim.x_m + off_m.x(), aim.y_m + off_m.y(), aim.yaw_rad + off_rad};
    if (!std::isfinite(terrain.HeightAt(aim.x_m, aim.y_m))) return;
  }
}

/// Through the ground under both wheels and the caster; level on blocks, and where a table ends.
Plane OdeWorld::Bodies::PlaneUnder(const geometry::Pose2& robot) const {
  const auto ground = [&](double ahead_m, double left_m) {
    const geometry::Pose2 at = robot * geometry::Pose2{ahead_m, left_m, 0.0};
    return Vector3d(at.x_m, at.y_m, terrain.HeightAt(at.x_m, at.y_m));
  };
  const Vector3d left = ground(0.0, 0.5 * body.track_m), right = ground(0.0, -0.5 * body.track_m),
                 caster = ground(body.caster_ahead_m, 0.0);
  if (terrain.IsStepped() || !std::isfinite(left.z() + right.z() + caster.z())) {
    return {ground(0.0, 0.0), Vector3d::UnitZ()};
  }
  const Vector3d normal = (right - left).cross(caster - left).normalized();
  return {0.5 * (left + right), std::copysign(1.0, normal.z()) * normal};
}

/// Yaw is that of the forward axis seen from above, whatever the slope.
void OdeWorld::Bodies::PlaceOn(const Plane& plane, double yaw_rad) {
  Vector3d ahead(std::cos(yaw_rad), std::sin(yaw_rad), 0.0);
  ahead.z() = -plane.normal.dot(ahead) / plane.normal.z();
  Matrix3d world_from_plane;
  world_from_plane.col(2) = plane.normal;
  world_from_plane.col(1) = plane.normal.cross(ahead).normalized();
  world_from_plane.col(0) = world_from_plane.col(1).cross(plane.normal);
  const Stance stance =
      StanceOn(body, world_from_plane.transpose() * Vector3d(0.0, 0.0, -body.gravity_mps2));
  const Matrix3d world_from_robot =
      world_from_plane * Eigen::AngleAxisd(stance.pitch_rad, Vector3d::UnitY()).matrix();
  // The axle stands over the asked point, measured vertically.
  Vector3d origin = plane.point;
  origin.z() += stance.height_m / plane.normal.z();
  SetRotation(chassis, world_from_robot);
  SetPosition(chassis,
              origin + world_from_robot * Vector3d(body.com_ahead_m, 0.0, body.com_above_m));
  for (int side = 0; side < 2; ++side) {
    SetRotation(wheels[side], world_from_robot);
    SetPosition(wheels[side],
                origin + (side == 0 ? 0.5 : -0.5) * body.track_m * world_from_robot.col(1));
  }
  ReadState();
}

/// On rough ground: drops the robot with locked wheels and endless friction until it rests.
void OdeWorld::Bodies::Settle() {
  const double clearance_m = body.wheel_radius_m - body.rim_clearance_m;
  for (const dBodyID part : {chassis, wheels[0], wheels[1]}) {
    SetPosition(part, Vector(dBodyGetPosition(part)) + clearance_m * Vector3d::UnitZ());
  }
  ReadState();
  settling = true;
  const WheelDrive locked{0.0, 0.0, std::numeric_limits<double>::infinity()};
  for (double t_s = 0.0; t_s < kSettle_s && !fault; t_s += step_s) Step({locked, locked});
  settling = false;
  for (const dBodyID part : {chassis, wheels[0], wheels[1]}) {
    dBodySetLinearVel(part, 0.0, 0.0, 0.0);
    dBodySetAngularVel(part, 0.0, 0.0, 0.0);
  }
  state.wheel_angle_rad = {};
  ReadState();
}

/// An aborted step leaves unfinished jobs, for which ODE's destructors fail: everything is leaked.
void OdeWorld::Bodies::Abandon() {
  static_cast<void>(contacts.release());
  static_cast<void>(world.release());
  static_cast<void>(threading.release());
}

void OdeWorld::Bodies::Step(const std::array<WheelDrive, 2>& drives,
                            const std::array<double, 2>& uneven) {
  if (fault || fall) return;
  for (const WheelDrive& drive : drives) {
    if (!std::isfinite(drive.target_rad_s + drive.compliance_rad_s_per_nm + drive.friction_nm) ||
        std::isnan(drive.limit_nm)) {
      fault = "a wheel drive is not a number";
      return;
    }
  }
  for (int side = 0; side < 2; ++side) SetDrive(side, drives[side]);
  try {
    dJointGroupEmpty(contacts.get());
    MakeContacts(uneven);
    dWorldStep(world.get(), step_s);
  } catch (const OdeFailure& failure) {
    fault = failure.what();
    Abandon();
    return;
  }
  for (int side = 0; side < 2; ++side) {
    state.wheel_angle_rad[side] += step_s * dJointGetHingeAngleRate(hinges[side]);
  }
  ReadState();
  fault = FaultOf(state, terrain);
  if (!fault) fall = FallOf(state, terrain);
}

/// ODE's hinge motor solves rate + cfm x torque = target [ODE manual, "CFM"], which is the drive's
/// torque line at the rate the step ends with. Dry friction is a second motor that asks for rest.
void OdeWorld::Bodies::SetDrive(int side, const WheelDrive& drive) {
  dJointSetHingeParam(hinges[side], dParamVel, drive.target_rad_s);
  dJointSetHingeParam(hinges[side], dParamFMax, drive.limit_nm);
  dJointSetHingeParam(hinges[side], dParamCFM, drive.compliance_rad_s_per_nm);
  dJointSetAMotorParam(frictions[side], dParamFMax, drive.friction_nm);
}

void OdeWorld::Bodies::MakeContacts(const std::array<double, 2>& uneven) {
  const double margin_m = step_s * (state.velocity_mps.norm() + kFaster_mps);
  const ContactScene scene{body, terrain, state, uneven, margin_m};
  for (int side = 0; side < 2; ++side) {
    AddWheelContacts(scene, side, Vector(dBodyGetPosition(wheels[side])), found);
    Add(wheel_contacts[side], settling);
  }
  AddCasterContacts(scene, found);
  Add(caster_contacts, settling);
  AddRimContacts(scene, found);
  Add(rim_contacts, false);
}

/// Gives the contacts found to ODE and forgets them. `sticks`: whatever the friction.
void OdeWorld::Bodies::Add(PartContacts& part, bool sticks) {
  std::vector<std::optional<double>> loads_n;
  for (const GroundContact& ground : found) {
    // Over blocks a load comes and goes from step to step, so that the last one tells little.
    loads_n.push_back(terrain.IsStepped() ? std::nullopt : part.LastLoad_n(ground.at.normal));
  }
  part.normals.clear();
  part.forces.resize(found.size());  // ODE keeps pointers into it until the step is done
  for (size_t i = 0; i < found.size(); ++i) {
    dContact contact = ContactOf(found[i], loads_n[i]);
    if (sticks) contact.surface.mu = dInfinity;
    const dJointID joint = dJointCreateContact(world.get(), contacts.get(), &contact);
    dJointAttach(joint, part.part, nullptr);
    dJointSetFeedback(joint, &part.forces[i]);
    part.normals.push_back(found[i].at.normal);
  }
  found.clear();
}

/// The limit of friction is that of the last step's load: of this step ODE knows it only without
/// friction, that is with wheels that spin freely, which leans the robot by more the longer the
/// step is. A new contact has no other.
dContact OdeWorld::Bodies::ContactOf(const GroundContact& ground,
                                     std::optional<double> load_n) const {
  dContact contact{};
  dSurfaceParameters& surface = contact.surface;
  surface.mode = dContactSoftERP | dContactSoftCFM | dContactFDir1 | dContactSlip1 | dContactSlip2;
  surface.mu = ground.mu;
  if (load_n) {
    surface.mu *= *load_n;
  } else {
    surface.mode |= dContactApprox1;
  }
  surface.soft_erp = contact_erp;
  surface.soft_cfm = contact_cfm;
  const double limit_n =
      ground.mu * std::max(load_n.value_or(ground.usual_load_n), 0.1 * ground.usual_load_n);
  const auto slip = [&](double creep_mps) {
    return kLeastSlip_mps_per_n + (limit_n > 0.0 ? creep_mps / limit_n : 0.0);
  };
  surface.slip1 = slip(ground.creep_along_mps);
  surface.slip2 = slip(ground.creep_across_mps);
  if (ground.uneven_mps != 0.0) {
    surface.mode |= dContactMotion2;  // along normal x direction, to the rear
    surface.motion2 = -ground.uneven_mps;
  }
  contact.geom.depth = std::max(0.0, ground.at.depth_m);
  if (ground.at.depth_m < 0.0) {
    // The same spring and damper, which begins to push when the step would end beyond the surface:
    // a contact that is noticed only when it is deep has stored energy that nobody spent.
    surface.mode |= dContactMotionN;
    surface.motionN = contact_erp / step_s * ground.at.depth_m;
  }
  Eigen::Map<Vector3d>(contact.geom.pos) = ground.at.point;
  Eigen::Map<Vector3d>(contact.geom.normal) = ground.at.normal;
  Eigen::Map<Vector3d>(contact.fdir1) = ground.direction;
  return contact;
}

void OdeWorld::Bodies::ReadState() {
  state.world_from_robot = Rotation(chassis);
  const Vector3d arm = state.world_from_robot * Vector3d(-body.com_ahead_m, 0.0, -body.com_above_m);
  state.position_m = Vector(dBodyGetPosition(chassis)) + arm;
  state.spin_rad_s = Vector(dBodyGetAngularVel(chassis));
  state.velocity_mps = Vector(dBodyGetLinearVel(chassis)) + state.spin_rad_s.cross(arm);
  for (int side = 0; side < 2; ++side) {
    state.wheel_rate_rad_s[side] = dJointGetHingeAngleRate(hinges[side]);
  }
}

OdeWorld::OdeWorld(const BodyOptions& body, const Terrain& terrain, const geometry::Pose2& start,
                   double step_s)
    : bodies_(std::make_unique<Bodies>(body, terrain, step_s)) {
  bodies_->Place(start);
}
OdeWorld::~OdeWorld() = default;
OdeWorld::OdeWorld(OdeWorld&&) noexcept = default;
OdeWorld& OdeWorld::operator=(OdeWorld&&) noexcept = default;

void OdeWorld::Step(const std::array<WheelDrive, 2>& drives, const std::array<double, 2>& uneven) {
  bodies_->Step(drives, uneven);
}

void OdeWorld::Launch(double speed_mps) {
  const Matrix3d& world_from_robot = bodies_->state.world_from_robot;
  const Vector3d velocity = speed_mps * world_from_robot.col(0);
  const Vector3d spin = speed_mps / bodies_->body.wheel_radius_m * world_from_robot.col(1);
  dBodySetLinearVel(bodies_->chassis, velocity.x(), velocity.y(), velocity.z());
  for (const dBodyID wheel : bodies_->wheels) {
    dBodySetLinearVel(wheel, velocity.x(), velocity.y(), velocity.z());
    dBodySetAngularVel(wheel, spin.x(), spin.y(), spin.z());
  }
  bodies_->ReadState();
}

const WorldState& OdeWorld::State() const { return bodies_->state; }

std::array<Grip, 2> OdeWorld::WheelGrip() const {
  std::array<Grip, 2> grips;
  for (int side = 0; side < 2; ++side) {
    const Vector3d p = Vector(dBodyGetPosition(bodies_->wheels[side]));
    grips[side] = bodies_->terrain.GripAt(p.x(), p.y());
  }
  return grips;
}

double OdeWorld::Energy_j() const {
  double energy_j = 0.0;
  for (const dBodyID part : {bodies_->chassis, bodies_->wheels[0], bodies_->wheels[1]}) {
    dMass mass;
    dBodyGetMass(part, &mass);
    const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> inertia(mass.I);
    const Vector3d spin = Rotation(part).transpose() * Vector(dBodyGetAngularVel(part));
    energy_j += 0.5 * mass.mass * Vector(dBodyGetLinearVel(part)).squaredNorm() +
                0.5 * spin.dot(inertia.leftCols<3>() * spin) +
                mass.mass * bodies_->body.gravity_mps2 * dBodyGetPosition(part)[2];
  }
  return energy_j;
}

const std::optional<std::string>& OdeWorld::Fault() const { return bodies_->fault; }
const std::optional<std::string>& OdeWorld::Fall() const { return bodies_->fall; }

}  // namespace rift::simulation
